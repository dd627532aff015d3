// The shim between this firmware and the bench: the only file that knows omnihil_firmware.h. It plays the
// board: copies sensors into the hardware layer, calls what the timer interrupt would call, copies registers
// back.
#include <cmath>
#include <new>

#include "examples/firmware_cpp/robot.h"
#include "firmware_iface/omnihil_firmware.h"

namespace {

using example::Hardware;
using example::kPwmTop;
using example::kWheelCount;
using example::Robot;

constexpr std::uint32_t kTimerPeriod_us = 500;

Robot& robot_in(void* state) { return *static_cast<Robot*>(state); }
const Robot& robot_in(const void* state) { return *static_cast<const Robot*>(state); }

float narrow(double x) { return static_cast<float>(x); }

int init(void* state, const omnihil_robot_config* c) {
  Robot* robot = new (state) Robot();  // all of the firmware's memory is the state block
  example::Build build;
  for (std::size_t n = 0; n < kWheelCount; ++n) build.wheel_angle_rad[n] = narrow(c->wheel_angle_rad[n]);
  build.wheel_radius_m = narrow(c->wheel_radius_m);
  build.wheel_center_radius_m = narrow(c->wheel_center_radius_m);
  build.gear_ratio = narrow(c->gear_ratio);
  build.counts_per_rotor_turn = narrow(c->encoder_counts_per_rotor_turn);
  build.volt_per_rotor_rad_s = narrow(c->motor_torque_constant_Nm_per_A);
  if (c->command_timeout_s > 0.0) build.silence_us = static_cast<std::uint64_t>(c->command_timeout_s * 1e6);
  robot->start(build);
  return 0;
}

void command(void* state, const omnihil_command* c, std::uint64_t now_us) {
  Robot& robot = robot_in(state);
  std::array<float, kWheelCount> values{};
  switch (c->mode) {
    case OMNIHIL_MODE_BODY_VELOCITY:
      return robot.order_body(narrow(c->v_forward_m_s), narrow(c->v_left_m_s), narrow(c->omega_body_rad_s),
                              now_us);
    case OMNIHIL_MODE_WHEEL_SPEED:
      for (std::size_t n = 0; n < kWheelCount; ++n) values[n] = narrow(c->omega_wheel_rad_s[n]);
      return robot.order_wheels(values, now_us);
    case OMNIHIL_MODE_WHEEL_DUTY:
      for (std::size_t n = 0; n < kWheelCount; ++n) values[n] = narrow(c->duty_ratio[n]);
      return robot.order_duty(values, now_us);
    default:
      return robot.order_off(now_us);
  }
}

void tick(void* state, const omnihil_sensors* in, omnihil_drive* out) {
  Robot& robot = robot_in(state);
  Hardware& board = robot.hardware;
  for (std::size_t n = 0; n < kWheelCount; ++n) {
    board.encoder_timer[n] = static_cast<std::uint16_t>(in->encoder_counts[n]);  // the timer's lower 16 bits
  }
  board.battery_mV = static_cast<std::uint16_t>(in->bus_voltage_V * 1000.0);
  robot.poll(in->now_us);
  for (std::size_t n = 0; n < kWheelCount; ++n) {
    out->mode[n] = board.bridges_on ? OMNIHIL_DRIVE_DUTY : OMNIHIL_DRIVE_COAST;
    out->duty_ratio[n] = static_cast<double>(board.pwm_compare[n]) / kPwmTop;
  }
}

void feedback(const void* state, omnihil_feedback* out) {
  const Robot& robot = robot_in(state);
  out->now_us = robot.now_us();
  out->battery_V = static_cast<double>(robot.battery_V());
  if (robot.silent()) out->flags |= OMNIHIL_FEEDBACK_COMMAND_TIMEOUT;
  for (int n = 0; n < kWheelCount; ++n) {
    const Robot::Wheel& wheel = robot.wheel(n);
    out->omega_wheel_rad_s[n] = static_cast<double>(wheel.omega_rad_s);
    out->omega_wheel_target_rad_s[n] = static_cast<double>(wheel.target_rad_s);
    out->wheel_integral[n] = static_cast<double>(wheel.integral_V);
    out->duty_ratio[n] = static_cast<double>(wheel.duty);
  }
}

int set_gains(void*, const omnihil_gains*) { return 1; }  // compiled in: every set is refused
void get_gains(const void*, omnihil_gains*) {}

const omnihil_firmware_api kApi = {
    .abi_version = OMNIHIL_FIRMWARE_ABI,
    .struct_bytes = sizeof(omnihil_firmware_api),
    .name = "example firmware in C++",
    .radio_format = nullptr,
    .control_period_us = kTimerPeriod_us,
    .state_bytes = sizeof(Robot),
    .init = init,
    .command = command,
    .radio_receive = nullptr,
    .radio_transmit = nullptr,
    .set_gains = set_gains,
    .get_gains = get_gains,
    .tick = tick,
    .feedback = feedback,
    .motor_init = nullptr,
    .motor_tick = nullptr,
};

}  // namespace

extern "C" const omnihil_firmware_api* omnihil_firmware_get(std::uint32_t version) {
  return version == OMNIHIL_FIRMWARE_ABI ? &kApi : nullptr;
}
