#include "protocols/dongles/rem_robot.h"

#include <cassert>
#include <cmath>
#include <numbers>
#include <string_view>

#include "protocols/codec.h"

namespace omnihil::rem {
namespace {

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

void put(Values& out, int index, double number) {
  if (index < 0) return;
  const auto i = static_cast<std::size_t>(index);
  out.fields[i] = nearest_value(out.message->fields[i], number);
}
void put(Values& out, std::string_view name, double number) {
  put(out, out.message->field_index(name), number);
}

// One row per field of RobotStateInfo: the team's name and where its content comes from.
struct StateInfoRow {
  std::string_view name;
  double (*get)(const RobotState& state);
};
#define ROW(name, expression)                                      \
  StateInfoRow {                                                   \
    name, [](const RobotState& s) -> double { return expression; } \
  }
constexpr StateInfoRow kStateInfo[] = {
    ROW("xsensAcc1", s.feedback.accel_x_m_s2),
    ROW("xsensAcc2", s.feedback.accel_y_m_s2),
    ROW("xsensYaw", s.feedback.yaw_rad),
    ROW("rateOfTurn", s.feedback.omega_body_rad_s),
    ROW("wheelSpeed1", s.feedback.omega_wheel_rad_s[0]),
    ROW("wheelSpeed2", s.feedback.omega_wheel_rad_s[1]),
    ROW("wheelSpeed3", s.feedback.omega_wheel_rad_s[2]),
    ROW("wheelSpeed4", s.feedback.omega_wheel_rad_s[3]),
    ROW("dribbleSpeed", s.feedback.omega_dribbler_rad_s),
    ROW("filteredDribbleSpeed", s.feedback.omega_dribbler_rad_s),
    ROW("dribblespeedBeforeGotBall", s.omega_dribbler_before_ball_rad_s),
    ROW("bodyXIntegral", s.feedback.body_integral[0]),
    ROW("bodyYIntegral", s.feedback.body_integral[1]),
    ROW("bodyWIntegral", s.feedback.body_integral[2]),
    ROW("bodyYawIntegral", s.feedback.body_integral[3]),
    ROW("wheel1Integral", s.feedback.wheel_integral[0]),
    ROW("wheel2Integral", s.feedback.wheel_integral[1]),
    ROW("wheel3Integral", s.feedback.wheel_integral[2]),
    ROW("wheel4Integral", s.feedback.wheel_integral[3]),
    ROW("wheelSpeedRef1", s.feedback.omega_wheel_target_rad_s[0]),
    ROW("wheelSpeedRef2", s.feedback.omega_wheel_target_rad_s[1]),
    ROW("wheelSpeedRef3", s.feedback.omega_wheel_target_rad_s[2]),
    ROW("wheelSpeedRef4", s.feedback.omega_wheel_target_rad_s[3]),
    ROW("wheelController_1", s.feedback.duty_ratio[0]),
    ROW("wheelController_2", s.feedback.duty_ratio[1]),
    ROW("wheelController_3", s.feedback.duty_ratio[2]),
    ROW("wheelController_4", s.feedback.duty_ratio[3]),
    ROW("bodyController_u", s.feedback.body_output[0]),
    ROW("bodyController_v", s.feedback.body_output[1]),
    ROW("bodyController_w", s.feedback.body_output[2]),
    ROW("bodyController_yaw", s.feedback.body_output[3]),
    ROW("bodyControllerRef_u", s.feedback.body_target[0]),
    ROW("bodyControllerRef_v", s.feedback.body_target[1]),
    ROW("bodyControllerRef_w", s.feedback.body_target[2]),
    ROW("bodyControllerRef_yaw", s.feedback.body_target[3]),
    ROW("wheelSpeedDerivativeFiltered1", s.feedback.wheel_accel_rad_s2[0]),
    ROW("wheelSpeedDerivativeFiltered2", s.feedback.wheel_accel_rad_s2[1]),
    ROW("wheelSpeedDerivativeFiltered3", s.feedback.wheel_accel_rad_s2[2]),
    ROW("wheelSpeedDerivativeFiltered4", s.feedback.wheel_accel_rad_s2[3]),
    ROW("bodyXDerivativeFiltered", s.feedback.body_derivative[0]),
    ROW("bodyYDerivativeFiltered", s.feedback.body_derivative[1]),
    ROW("bodyZDerivativeFiltered", s.feedback.body_derivative[2]),
    ROW("bodyYawDerivativeFiltered", s.feedback.body_derivative[3]),
};
#undef ROW

// The gains' names: P, I, D and D2 of body x, y, omega, yaw; P, I, D of the wheels.
constexpr std::string_view kGainNames[OMNIHIL_LOOPS][4] = {
    {"PbodyX", "IbodyX", "DbodyX", "DbodyX2"}, {"PbodyY", "IbodyY", "DbodyY", "DbodyY2"},
    {"PbodyW", "IbodyW", "DbodyW", "DbodyW2"}, {"PbodyYaw", "IbodyYaw", "DbodyYaw", "DbodyYaw2"},
    {"Pwheels", "Iwheels", "Dwheels", ""},
};

}  // namespace

RobotGains to_gains(const Values& values, const RobotGains& known) {
  RobotGains gains = known;
  for (std::size_t loop = 0; loop < OMNIHIL_LOOPS; ++loop) {
    double* const parts[] = {&gains.p[loop], &gains.i[loop], &gains.d[loop], &gains.d2[loop]};
    for (std::size_t part = 0; part < 4; ++part) {
      const int index = values.message->field_index(kGainNames[loop][part]);
      if (index >= 0) *parts[part] = values.fields[static_cast<std::size_t>(index)].number;
    }
  }
  return gains;
}

bool wants_state_info(const Values& values) { return values.number_or("sendStateInfo", 1.0) != 0.0; }

Telemetry::Telemetry(const RadioFormat& format) : format_(format) {
  const Message* state_info = message_of_role(format.messages, MessageRole::kStateInfo);
  assert(state_info != nullptr);
  for (const StateInfoRow& row : kStateInfo) state_info_fields_.push_back(state_info->field_index(row.name));
  const int timestamp = state_info->field_index("timestamp");
  centiseconds_ = state_info->fields[static_cast<std::size_t>(timestamp)].bits == 40;
}

void Telemetry::start(MessageRole role, const Header& header, Values& out) const {
  out = Values{};
  out.message = message_of_role(format_.messages, role);
  assert(out.message != nullptr);
  put(out, "toPC", 1.0);
  put(out, "fromRobotId", header.from_robot);
  put(out, "fromColor", header.team == Team::kBlue ? 1.0 : 0.0);
  put(out, "fromBS", header.from_base_station ? 1.0 : 0.0);
  put(out, "messageId", header.message_id % 16);
  put(out, "timestamp", static_cast<double>(centiseconds_ ? header.time_ms / 10 : header.time_ms));
}

void Telemetry::robot_feedback(const RobotState& state, const Header& header, Values& out) const {
  start(MessageRole::kFeedback, header, out);
  const RobotFeedback& f = state.feedback;
  put(out, "rho", std::hypot(f.v_forward_m_s, f.v_left_m_s));
  put(out, "theta", wrapped(std::atan2(f.v_left_m_s, f.v_forward_m_s)));
  put(out, "yaw", wrapped(f.yaw_rad));
  put(out, "angle", wrapped(f.yaw_rad));
  // v8 carries volts (15 to 30); v5's four bits hold whole volts above 15 (our choice: its scale is not
  // public).
  const bool volts =
      out.message->fields[static_cast<std::size_t>(out.message->field_index("batteryLevel"))].bits > 4;
  put(out, "batteryLevel", volts ? f.battery_V : f.battery_V - 15.0);
  const auto flag = [&](std::string_view name, std::uint32_t bit) {
    put(out, name, (f.flags & bit) != 0 ? 1.0 : 0.0);
  };
  flag("XsensCalibrated", OMNIHIL_FEEDBACK_IMU_READY);
  flag("ballSensorWorking", OMNIHIL_FEEDBACK_BALL_SENSOR_OK);
  flag("ballSensorSeesBall", OMNIHIL_FEEDBACK_BALL_SEEN);
  flag("dribblerSeesBall", OMNIHIL_FEEDBACK_DRIBBLER_SEES_BALL);
  flag("kickerFault", OMNIHIL_FEEDBACK_KICKER_FAULT);
  flag("kickerOn", OMNIHIL_FEEDBACK_KICKER_ON);
  flag("capacitorCharged", OMNIHIL_FEEDBACK_CAPACITOR_CHARGED);
  put(out, "kickerVoltage", f.capacitor_V);
  put(out, "ballPos", 0.0);
}

void Telemetry::robot_state_info(const RobotState& state, const Header& header, Values& out) const {
  start(MessageRole::kStateInfo, header, out);
  for (std::size_t i = 0; i < state_info_fields_.size(); ++i)
    put(out, state_info_fields_[i], kStateInfo[i].get(state));
}

void Telemetry::robot_gains(const RobotState& state, const Header& header, Values& out) const {
  start(MessageRole::kGains, header, out);
  for (std::size_t loop = 0; loop < OMNIHIL_LOOPS; ++loop) {
    const double parts[] = {state.gains.p[loop], state.gains.i[loop], state.gains.d[loop],
                            state.gains.d2[loop]};
    for (std::size_t part = 0; part < 4; ++part) put(out, kGainNames[loop][part], parts[part]);
  }
}

}  // namespace omnihil::rem
