// What a host's command becomes in a radio format reaches the robot as the same command.
#include <array>
#include <cmath>

#include "protocols/codec.h"
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

constexpr int kRobot = 5;

// The last command that reaches the robot, through the format's own dongle.
RobotCommand through_air(const RadioFormat& format, const RobotCommand& command, Team team = Team::kYellow) {
  Bench bench(format, {.robot_ids = {kRobot}, .team = team});
  Bytes bytes;
  EXPECT_TRUE(format.encode_command(command, {.robot_id = kRobot, .team = team}, bytes)) << format.id;
  bench.write(bytes);
  bench.run_to(50 * kMs);
  const auto heard = bench.sink.of_robot(kRobot);
  EXPECT_FALSE(heard.empty()) << format.id;
  return heard.empty() ? RobotCommand{} : heard.back().command;
}

// One count of a field (encoding rounds down), where a packet to robots has it; 0: floats, which say these
// numbers exactly.
double step_of(const RadioFormat& format, std::string_view name) {
  double step = 0.0;
  for (const Message& message : format.messages) {
    const int index = message.field_index(name);
    if (message.direction != Direction::kToRobot || index < 0) continue;
    const Field& field = message.fields[static_cast<std::size_t>(index)];
    step = std::max(step, field_step(field));
  }
  return step;
}

// The same of a format that may have another name for it: the coarsest ranged or scaled field of the unit, in packets that
// are commands. A format with neither scales its counts itself: 1 part in 64 then, since the coarsest known to
// us has 8 bits for both signs.
double step_of(const RadioFormat& format, std::string_view name, std::string_view unit, double value) {
  double step = 0.0;
  bool has_unit = false;
  for (const Message& message : format.messages) {
    if (message.direction != Direction::kToRobot) continue;
    if (message.field_index(name) >= 0) return step_of(format, name);
    for (const Field& field : message.fields) {
      if (field.unit != unit) continue;
      if (field.kind == FieldKind::kFloat32) has_unit = true;
      if (field.kind != FieldKind::kRanged32 && field.kind != FieldKind::kScaled) continue;
      has_unit = true;
      step = std::max(step, field_step(field));
    }
  }
  return has_unit ? step : std::abs(value) / 64.0;
}

RobotCommand velocity() {
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = 1.25, command.v_left_m_s = -0.5, command.omega_body_rad_s = 3.0;
  return command;
}
// As the format can say it: REM's velocities are in the field frame, and ibis has headings in place of a yaw rate.
RobotCommand velocity_in(const RadioFormat& format) {
  RobotCommand command = velocity();
  Bytes bytes;
  if (format.encode_command(command, {.robot_id = kRobot}, bytes)) return command;
  command.flags = OMNIHIL_COMMAND_FIELD_FRAME;
  if (format.encode_command(command, {.robot_id = kRobot}, bytes)) return command;
  command.flags |= OMNIHIL_COMMAND_YAW_TARGET;
  command.omega_body_rad_s = 0.0;
  command.yaw_target_rad = 0.7;
  return command;
}

TEST(RadioCommand, VelocityArrivesWithinTheFieldsSteps) {
  for (const RadioFormat* format : radio_formats()) {
    if (!format->can_drive(OMNIHIL_MODE_BODY_VELOCITY)) continue;
    const RobotCommand sent = velocity_in(*format);
    const RobotCommand got = through_air(*format, sent);
    const double speed_m_s = std::hypot(sent.v_forward_m_s, sent.v_left_m_s);
    const double off_m_s = step_of(*format, "rho", "m/s", speed_m_s) + speed_m_s * step_of(*format, "theta");
    EXPECT_EQ(got.mode, sent.mode);
    EXPECT_EQ(got.flags, sent.flags);
    EXPECT_NEAR(got.v_forward_m_s, sent.v_forward_m_s, off_m_s) << format->id;
    EXPECT_NEAR(got.v_left_m_s, sent.v_left_m_s, off_m_s) << format->id;
    EXPECT_NEAR(got.omega_body_rad_s, sent.omega_body_rad_s,
                step_of(*format, "angularVelocity", "rad/s", sent.omega_body_rad_s));
    EXPECT_NEAR(got.yaw_target_rad, sent.yaw_target_rad, 1e-3) << format->id;
  }
}

TEST(RadioCommand, EachKindOfDriveThatAFormatNamesArrives) {
  for (const RadioFormat* format : radio_formats()) {
    for (const std::uint32_t mode : {OMNIHIL_MODE_COAST, OMNIHIL_MODE_WHEEL_SPEED, OMNIHIL_MODE_WHEEL_DUTY}) {
      RobotCommand sent{};
      sent.mode = mode;
      if (mode == OMNIHIL_MODE_WHEEL_DUTY) sent.duty_ratio[2] = -0.25;
      if (mode == OMNIHIL_MODE_WHEEL_SPEED) sent.omega_wheel_rad_s[1] = 40.0;
      if (!format->can_drive(mode)) {
        Bytes bytes;
        EXPECT_FALSE(format->encode_command(sent, {.robot_id = kRobot}, bytes)) << format->id << " " << mode;
        continue;
      }
      const RobotCommand got = through_air(*format, sent);
      EXPECT_EQ(got.mode, mode) << format->id;
      EXPECT_NEAR(got.duty_ratio[2], sent.duty_ratio[2], step_of(*format, "wheelPWM3", "", 0.25));
      EXPECT_NEAR(got.omega_wheel_rad_s[1], sent.omega_wheel_rad_s[1],
                  step_of(*format, "wheelSpeedRef2", "rad/s", 40.0));
    }
  }
}

TEST(RadioCommand, KickDribblerAndHeadingArriveByRem) {
  for (const char* id : {"roboteam-rem-v5", "roboteam-rem-v8"}) {
    const RadioFormat& format = *find_radio_format(id);
    RobotCommand sent = velocity_in(format);
    sent.flags |= OMNIHIL_COMMAND_YAW_TARGET | OMNIHIL_COMMAND_CAMERA_YAW;
    sent.yaw_target_rad = 1.0, sent.camera_yaw_rad = -2.0;
    sent.dribbler_ratio = 1.0;
    for (const std::array<std::uint32_t, 2> kick :
         {std::array<std::uint32_t, 2>{OMNIHIL_KICK_STRAIGHT, OMNIHIL_KICK_ON_BALL},
          {OMNIHIL_KICK_STRAIGHT, OMNIHIL_KICK_AT_YAW},
          {OMNIHIL_KICK_STRAIGHT, OMNIHIL_KICK_NOW},
          {OMNIHIL_KICK_CHIP, OMNIHIL_KICK_NOW}}) {
      sent.kick = kick[0], sent.kick_when = kick[1], sent.v_kick_m_s = 3.0;
      const RobotCommand got = through_air(format, sent, Team::kBlue);
      EXPECT_EQ(got.flags, sent.flags) << id;
      EXPECT_EQ(got.kick, sent.kick) << id;
      EXPECT_EQ(got.kick_when, sent.kick_when) << id;
      EXPECT_NEAR(got.v_kick_m_s, 3.0, step_of(format, "kickChipPower"));
      EXPECT_NEAR(got.yaw_target_rad, 1.0, std::max(step_of(format, "yaw"), step_of(format, "angle")));
      EXPECT_NEAR(got.camera_yaw_rad, -2.0,
                  std::max(step_of(format, "cameraYaw"), step_of(format, "cameraAngle")));
      EXPECT_NEAR(got.dribbler_ratio, 1.0, step_of(format, "dribbler"));
    }
  }
}

TEST(RadioCommand, SetUpGoesOnceWhereARobotNeedsIt) {
  RobotCommand duty{};
  duty.mode = OMNIHIL_MODE_WHEEL_DUTY;
  const RadioFormat& hermes = *find_radio_format("ulaval-hermes");
  Bytes first, next;
  ASSERT_TRUE(hermes.encode_command(duty, {.robot_id = kRobot}, first));
  ASSERT_TRUE(hermes.encode_command(duty, {.robot_id = kRobot, .set_up = false}, next));
  EXPECT_EQ(next, encode(hermes, "OPEN_LOOP_COMMAND", {{"robot", kRobot}}));
  EXPECT_EQ(first, encode(hermes, "SET_REGISTER", {{"robot", kRobot}, {"register", 0}, {"value", 0}}) + next);
  // REM tells with each packet what it is.
  const RadioFormat& rem = *find_radio_format("roboteam-rem-v8");
  first.clear(), next.clear();
  ASSERT_TRUE(rem.encode_command(duty, {.robot_id = kRobot}, first));
  ASSERT_TRUE(rem.encode_command(duty, {.robot_id = kRobot, .set_up = false}, next));
  EXPECT_EQ(first, next);
  EXPECT_EQ(first, encode(rem, "REM_RobotCommandTesting",
                          {{"toRobotId", kRobot}, {"fromPC", 1}, {"useWheelPWMRef", 1}}));
}

TEST(RadioCommand, WhatAFormatCannotSayLeavesNoBytes) {
  const auto refused = [](const char* id, const RobotCommand& command) {
    Bytes bytes{7};
    const bool said = find_radio_format(id)->encode_command(command, {.robot_id = 1}, bytes);
    return !said && bytes == Bytes{7};
  };
  RobotCommand wheels{};
  wheels.mode = OMNIHIL_MODE_WHEEL_SPEED;
  RobotCommand kick = velocity();
  kick.kick = OMNIHIL_KICK_STRAIGHT;
  EXPECT_TRUE(refused("ulaval-hermes", wheels));
  EXPECT_TRUE(refused("ulaval-hermes", kick));
  EXPECT_TRUE(refused("roboteam-rem-v5", wheels));
  for (const char* rem : {"roboteam-rem-v5", "roboteam-rem-v8"}) {
    EXPECT_TRUE(refused(rem, velocity())) << "a velocity in the robot's own frame";
    RobotCommand turn = velocity();
    turn.v_forward_m_s = turn.v_left_m_s = 0.0;
    EXPECT_FALSE(refused(rem, turn));
    RobotCommand fast = velocity();
    fast.flags = OMNIHIL_COMMAND_FIELD_FRAME;
    fast.v_forward_m_s = 31.0;  // above the range of rho in both versions
    EXPECT_TRUE(refused(rem, fast));
    RobotCommand pulse = kick;
    pulse.flags = OMNIHIL_COMMAND_FIELD_FRAME;
    pulse.kick_pulse_s = 0.01;
    EXPECT_TRUE(refused(rem, pulse)) << "REM's kick is a speed";
  }
}

}  // namespace
}  // namespace omnihil
