// What a RoboTeam robot makes of a command, and what it says about itself.
#include "protocols/dongles/rem_robot.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "protocols/codec.h"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

using std::numbers::pi;
constexpr const char* kV8 = "roboteam-rem-v8";
constexpr const char* kV5 = "roboteam-rem-v5";

RobotCommand command(const char* format, const char* message, FieldValues fields) {
  const RadioFormat& f = *find_radio_format(format);
  const DecodeResult decoded = f.decode(encode(f, message, fields));
  EXPECT_EQ(decoded.error, PacketError::kNone);
  return rem::to_command(decoded.values);
}

TEST(RemRobotTest, PolarSpeedIsAVelocityInTheFieldFrame) {
  const RobotCommand c =
      command(kV8, "REM_RobotCommand", {{"rho", 2.0}, {"theta", pi / 3}, {"angularVelocity", -4.0}});
  EXPECT_EQ(c.mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
  EXPECT_EQ(c.flags, unsigned{OMNIHIL_COMMAND_FIELD_FRAME});
  EXPECT_NEAR(c.v_forward_m_s, 2.0 * std::cos(pi / 3), 1e-3);
  EXPECT_NEAR(c.v_left_m_s, 2.0 * std::sin(pi / 3), 1e-3);
  EXPECT_NEAR(c.omega_body_rad_s, -4.0, 1e-3);
}

TEST(RemRobotTest, HeadingCameraAndAccelerationKeepTheirMeaningInBothVersions) {
  const RobotCommand v8 = command(kV8, "REM_RobotCommand",
                                  {{"yaw", 1.0},
                                   {"useYaw", 1},
                                   {"cameraYaw", -2.0},
                                   {"useCameraYaw", 1},
                                   {"acceleration_magnitude", 3.0},
                                   {"acceleration_angle", 0.5},
                                   {"reboot", 1}});
  EXPECT_EQ(v8.flags, unsigned{OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_YAW_TARGET |
                               OMNIHIL_COMMAND_CAMERA_YAW | OMNIHIL_COMMAND_REBOOT});
  EXPECT_NEAR(v8.yaw_target_rad, 1.0, 1e-4);
  EXPECT_NEAR(v8.camera_yaw_rad, -2.0, 1e-4);
  EXPECT_NEAR(v8.a_feedforward_m_s2, 3.0, 1e-3);
  EXPECT_NEAR(v8.a_feedforward_angle_rad, 0.5, 1e-4);
  const RobotCommand v5 =
      command(kV5, "REM_RobotCommand",
              {{"angle", 1.0}, {"useAbsoluteAngle", 1}, {"cameraAngle", -2.0}, {"useCameraAngle", 1}});
  EXPECT_EQ(v5.flags,
            unsigned{OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_YAW_TARGET | OMNIHIL_COMMAND_CAMERA_YAW});
  EXPECT_NEAR(v5.yaw_target_rad, 1.0, 1e-4);
  EXPECT_NEAR(v5.camera_yaw_rad, -2.0, 1e-4);
}

TEST(RemRobotTest, ChipGoesBeforeKickAndKickBeforeKickAtYaw) {
  const RobotCommand chip = command(kV8, "REM_RobotCommand",
                                    {{"doChip", 1}, {"doKick", 1}, {"kickAtYaw", 1}, {"kickChipPower", 6.0}});
  EXPECT_EQ(chip.kick, unsigned{OMNIHIL_KICK_CHIP});
  EXPECT_EQ(chip.kick_when, unsigned{OMNIHIL_KICK_ON_BALL});
  EXPECT_NEAR(chip.v_kick_m_s, 6.0, 8.0 / 255.0);
  const RobotCommand forced = command(kV8, "REM_RobotCommand", {{"doKick", 1}, {"doForce", 1}});
  EXPECT_EQ(forced.kick, unsigned{OMNIHIL_KICK_STRAIGHT});
  EXPECT_EQ(forced.kick_when, unsigned{OMNIHIL_KICK_NOW});
  const RobotCommand at_yaw = command(kV8, "REM_RobotCommand", {{"kickAtYaw", 1}, {"kickChipPower", 4.0}});
  EXPECT_EQ(at_yaw.kick, unsigned{OMNIHIL_KICK_STRAIGHT});
  EXPECT_EQ(at_yaw.kick_when, unsigned{OMNIHIL_KICK_AT_YAW});
  const RobotCommand none = command(kV5, "REM_RobotCommand", {{"kickChipPower", 6.5}});
  EXPECT_EQ(none.kick, unsigned{OMNIHIL_KICK_NONE});
  EXPECT_EQ(none.v_kick_m_s, 0.0);
}

TEST(RemRobotTest, DribblerIsOnOrOffInV8AndHasStepsInV5) {
  EXPECT_EQ(command(kV8, "REM_RobotCommand", {{"dribblerOn", 1}}).dribbler_ratio, 1.0);
  EXPECT_EQ(command(kV8, "REM_RobotCommand", {}).dribbler_ratio, 0.0);
  EXPECT_NEAR(command(kV5, "REM_RobotCommand", {{"dribbler", 0.5}}).dribbler_ratio, 3.0 / 7.0, 1e-6);
}

TEST(RemRobotTest, TestingCommandDrivesWheelsBySpeedOrByDuty) {
  const char* testing = "REM_RobotCommandTesting";
  const RobotCommand speed =
      command(kV8, testing, {{"useWheelSpeedRef", 1}, {"wheelSpeedRef1", 10}, {"wheelSpeedRef4", -20}});
  EXPECT_EQ(speed.mode, unsigned{OMNIHIL_MODE_WHEEL_SPEED});
  EXPECT_NEAR(speed.omega_wheel_rad_s[0], 10.0, 0.031);
  EXPECT_NEAR(speed.omega_wheel_rad_s[3], -20.0, 0.031);
  const RobotCommand duty =
      command(kV8, testing, {{"useWheelPWMRef", 1}, {"wheelPWM2", 0.5}, {"wheelPWM3", -1.0}});
  EXPECT_EQ(duty.mode, unsigned{OMNIHIL_MODE_WHEEL_DUTY});
  EXPECT_NEAR(duty.duty_ratio[1], 0.5, 3.1e-5);
  EXPECT_EQ(duty.duty_ratio[2], -1.0);
  EXPECT_EQ(command(kV8, testing, {{"useWheelSpeedRef", 1}, {"useWheelPWMRef", 1}}).mode,
            unsigned{OMNIHIL_MODE_WHEEL_DUTY});
  EXPECT_EQ(command(kV8, testing, {{"rho", 1}}).mode, unsigned{OMNIHIL_MODE_BODY_VELOCITY});
  EXPECT_EQ(command(kV8, testing, {{"useAbsoluteYaw", 1}}).flags,
            unsigned{OMNIHIL_COMMAND_FIELD_FRAME | OMNIHIL_COMMAND_YAW_TARGET});
}

TEST(RemRobotTest, WheelsOffCoastsWhateverElseIsAsked) {
  EXPECT_EQ(command(kV8, "REM_RobotCommand", {{"rho", 3}, {"wheelsOff", 1}}).mode,
            unsigned{OMNIHIL_MODE_COAST});
  EXPECT_EQ(command(kV8, "REM_RobotCommandTesting", {{"useWheelPWMRef", 1}, {"wheelsOff", 1}}).mode,
            unsigned{OMNIHIL_MODE_COAST});
}

TEST(RemRobotTest, PacketThatOnlyAsksForAnAnswerIsNotActedOn) {
  for (const char* id : {kV8, kV5}) {
    Bench bench(id, {.robot_ids = {0}});
    bench.boot_robots();
    bench.step();
    bench.write(bench.encode(id == kV5 ? "REM_RobotCommand" : "REM_RobotCommandTesting",
                             {{"feedback", 1}, {"rho", 3}}));
    bench.run_to(20 * kMs);
    EXPECT_TRUE(bench.sink.heard.empty()) << id;
    EXPECT_EQ(bench.answers("REM_RobotFeedback").size(), 1u) << id;
  }
}

// Telemetry of one robot whose feedback is `feedback`, encoded and decoded again.
Values telemetry(const char* format, const char* message, const RobotFeedback& feedback) {
  const RadioFormat& f = *find_radio_format(format);
  const rem::Telemetry telemetry(f);
  rem::RobotState state;
  state.feedback = feedback;
  state.omega_dribbler_before_ball_rad_s = 77.0;
  Values values;
  if (std::string_view(message) == "REM_RobotFeedback") telemetry.robot_feedback(state, {}, values);
  if (std::string_view(message) == "REM_RobotStateInfo") telemetry.robot_state_info(state, {}, values);
  Bytes bytes;
  const auto encoded = f.encode(values, bytes);
  EXPECT_EQ(encoded.error, PacketError::kNone) << encoded.field;
  const DecodeResult decoded = f.decode(bytes);
  EXPECT_EQ(decoded.error, PacketError::kNone) << decoded.field;
  return decoded.values;
}

// One count of the field, plus float32 rounding.
double resolution(const Values& values, const char* name) {
  const Field& field = values.message->fields[static_cast<std::size_t>(values.message->field_index(name))];
  return (field.hi - field.lo) / (std::ldexp(1.0, field.bits) - 1.0) + 1e-3;
}

TEST(RemRobotTest, FeedbackCarriesBodyVelocityHeadingBatteryAndFlags) {
  RobotFeedback f{};
  f.v_forward_m_s = -1.0;
  f.v_left_m_s = 1.0;
  f.yaw_rad = 2.5 * pi;  // wraps to pi / 2
  f.battery_V = 24.2;
  f.capacitor_V = 210.9;
  f.flags = OMNIHIL_FEEDBACK_IMU_READY | OMNIHIL_FEEDBACK_BALL_SEEN | OMNIHIL_FEEDBACK_CAPACITOR_CHARGED;
  const Values v8 = telemetry(kV8, "REM_RobotFeedback", f);
  EXPECT_NEAR(v8.number("rho"), std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(v8.number("theta"), 0.75 * pi, 1e-3);
  EXPECT_NEAR(v8.number("yaw"), 0.5 * pi, 1e-3);
  EXPECT_NEAR(v8.number("batteryLevel"), 24.2, 1e-3);
  EXPECT_EQ(v8.number("kickerVoltage"), 210.0);
  EXPECT_EQ(v8.number("XsensCalibrated"), 1.0);
  EXPECT_EQ(v8.number("ballSensorSeesBall"), 1.0);
  EXPECT_EQ(v8.number("capacitorCharged"), 1.0);
  for (const char* off : {"ballSensorWorking", "dribblerSeesBall", "kickerFault", "kickerOn"}) {
    EXPECT_EQ(v8.number(off), 0.0) << off;
  }
  const Values v5 = telemetry(kV5, "REM_RobotFeedback", f);
  EXPECT_NEAR(v5.number("rho"), std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(v5.number("angle"), 0.5 * pi, 1e-3);
  EXPECT_EQ(v5.number("batteryLevel"), 9.0);  // whole volts above 15
  EXPECT_EQ(v5.number("ballSensorSeesBall"), 1.0);
}

RobotFeedback numbered_feedback() {
  RobotFeedback f{};
  f.accel_x_m_s2 = 1.0;
  f.accel_y_m_s2 = -2.0;
  f.yaw_rad = 3.0;
  f.omega_body_rad_s = -4.0;
  f.omega_dribbler_rad_s = 300.0;
  for (int i = 0; i < 4; ++i) {
    f.omega_wheel_rad_s[i] = 10.0 + i;
    f.body_integral[i] = 0.5 + i;
    f.wheel_integral[i] = 20.0 + i;
    f.omega_wheel_target_rad_s[i] = 30.0 + i;
    f.duty_ratio[i] = 0.1 + 0.1 * i;
    f.body_output[i] = 40.0 + i;
    f.body_target[i] = 50.0 + i;
    f.wheel_accel_rad_s2[i] = 60.0 + i;
    f.body_derivative[i] = 70.0 + i;
  }
  return f;
}

TEST(RemRobotTest, AllFortyThreeFieldsOfStateInfoCarryTheirOwnQuantity) {
  const std::vector<std::pair<const char*, double>> expected = {{"xsensAcc1", 1},
                                                                {"xsensAcc2", -2},
                                                                {"xsensYaw", 3},
                                                                {"rateOfTurn", -4},
                                                                {"wheelSpeed1", 10},
                                                                {"wheelSpeed2", 11},
                                                                {"wheelSpeed3", 12},
                                                                {"wheelSpeed4", 13},
                                                                {"dribbleSpeed", 300},
                                                                {"filteredDribbleSpeed", 300},
                                                                {"dribblespeedBeforeGotBall", 77},
                                                                {"bodyXIntegral", 0.5},
                                                                {"bodyYIntegral", 1.5},
                                                                {"bodyWIntegral", 2.5},
                                                                {"bodyYawIntegral", 3.5},
                                                                {"wheel1Integral", 20},
                                                                {"wheel2Integral", 21},
                                                                {"wheel3Integral", 22},
                                                                {"wheel4Integral", 23},
                                                                {"wheelSpeedRef1", 30},
                                                                {"wheelSpeedRef2", 31},
                                                                {"wheelSpeedRef3", 32},
                                                                {"wheelSpeedRef4", 33},
                                                                {"wheelController_1", 0.1},
                                                                {"wheelController_2", 0.2},
                                                                {"wheelController_3", 0.3},
                                                                {"wheelController_4", 0.4},
                                                                {"bodyController_u", 40},
                                                                {"bodyController_v", 41},
                                                                {"bodyController_w", 42},
                                                                {"bodyController_yaw", 43},
                                                                {"bodyControllerRef_u", 50},
                                                                {"bodyControllerRef_v", 51},
                                                                {"bodyControllerRef_w", 52},
                                                                {"bodyControllerRef_yaw", 53},
                                                                {"wheelSpeedDerivativeFiltered1", 60},
                                                                {"wheelSpeedDerivativeFiltered2", 61},
                                                                {"wheelSpeedDerivativeFiltered3", 62},
                                                                {"wheelSpeedDerivativeFiltered4", 63},
                                                                {"bodyXDerivativeFiltered", 70},
                                                                {"bodyYDerivativeFiltered", 71},
                                                                {"bodyZDerivativeFiltered", 72},
                                                                {"bodyYawDerivativeFiltered", 73}};
  ASSERT_EQ(expected.size(), 43u);
  const Values v8 = telemetry(kV8, "REM_RobotStateInfo", numbered_feedback());
  EXPECT_EQ(v8.message->fields.size(), 15u + 43u);  // header and body
  for (const auto& [name, number] : expected)
    EXPECT_NEAR(v8.number(name), number, resolution(v8, name)) << name;
  const Values v5 = telemetry(kV5, "REM_RobotStateInfo", numbered_feedback());
  for (std::size_t i = 0; i < 19; ++i) {
    EXPECT_NEAR(v5.number(expected[i].first), expected[i].second, resolution(v5, expected[i].first)) << i;
  }
}

TEST(RemRobotTest, ValuesOutsideTheirRangeAreSetToItsNearestEnd) {
  for (const double sign : {1.0, -1.0}) {
    RobotFeedback f{};
    double* const first = &f.battery_V;  // every double of the struct, in declaration order
    double* const last = &f.omega_dribbler_rad_s;
    for (double* p = first; p <= last; ++p) *p = sign * 1e30;
    for (const char* id : {kV8, kV5}) {
      const Values values = telemetry(id, "REM_RobotStateInfo", f);
      for (std::size_t i = 15; i < values.message->fields.size(); ++i) {
        const Field& field = values.message->fields[i];
        if (field.name == "dribblespeedBeforeGotBall") continue;
        const double end = sign > 0 ? field.hi : field.lo;
        EXPECT_NEAR(values.fields[i].number, end, 1e-3 * (field.hi - field.lo)) << id << " " << field.name;
      }
      const Values feedback = telemetry(id, "REM_RobotFeedback", f);
      EXPECT_LE(feedback.number("rho"), id == kV8 ? 30.001 : 8.001);
    }
  }
}

TEST(RemRobotTest, NumbersThatAreNotFiniteAreSentAsZero) {
  RobotFeedback f{};
  f.omega_wheel_rad_s[0] = std::numeric_limits<double>::quiet_NaN();
  f.omega_wheel_rad_s[1] = std::numeric_limits<double>::infinity();
  const Values values = telemetry(kV8, "REM_RobotStateInfo", f);
  EXPECT_NEAR(values.number("wheelSpeed1"), 0.0, resolution(values, "wheelSpeed1"));
  EXPECT_NEAR(values.number("wheelSpeed2"), 0.0, resolution(values, "wheelSpeed2"));
}

TEST(RemRobotTest, DribblerSpeedBeforeTheBallIsTheLastOneWithoutTheBall) {
  Bench bench(kV8, {.robot_ids = {0}});
  bench.robots[0].omega_dribbler_rad_s = 400.0;
  bench.step();
  bench.robots[0].omega_dribbler_rad_s = 250.0;
  bench.robots[0].flags = OMNIHIL_FEEDBACK_DRIBBLER_SEES_BALL;
  bench.write(bench.encode("REM_RobotCommand", {{"sendStateInfo", 1}}));
  bench.run_to(20 * kMs);
  const auto info = bench.answers("REM_RobotStateInfo");
  ASSERT_EQ(info.size(), 1u);
  EXPECT_NEAR(info[0].values.number("dribbleSpeed"), 250.0, 0.1);
  EXPECT_NEAR(info[0].values.number("dribblespeedBeforeGotBall"), 400.0, 0.1);
}

}  // namespace
}  // namespace omnihil
