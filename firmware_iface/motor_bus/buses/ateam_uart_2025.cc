// SSL A-Team wheel motor controllers, 2025: a UART per motor, 2 Mbaud 8E1, one little-endian struct per burst.
//
//   to the motor  52 bytes: 0 type (20h parameters, 21h motion), 4 crc (0, unchecked), then
//     motion      8 flags (1 reset, 2 telemetry), 12 kind (0 open loop, 1 velocity, 2 torque, 3 both),
//                 16 float set-point
//     parameters  8 what to write (bits), 12 time, 16 eight floats: velocity p i d i_max, current p i d i_max,
//                 48 clamp
//   from it       56 bytes: 80h parameters (one per parameter command), 81h motion every 5 ms while telemetry is on
//
// Source: SSL A-Team firmware f8968a4 and software-communication 0719fbf (behaviour of the running binary).
// Set-points in rad/s, N m for torque; open loop is its linear fit, clamped duty of
//   d = 0 for |w| < 4 rad/s, else 2 (0.00144873 w -+ 0.0057431).
// A command older than 100 ms: the bridge opens. `encoder_delta` at 20 is the speed as an integer, as there.
// Line m is motor m: front left, back left, back right, front right (--bus-order).
// Cannot: its own velocity and torque PIDs (motor_axis.h has ours; gains are stored and told, no more), its
// slew and filters, Hall, watchdog and reset faults (the flags are 0), the reset of a whole microcontroller
// (bit 0 forgets the command).
#include <algorithm>
#include <cmath>

#include "firmware_iface/motor_bus/motor_bus.h"

namespace omnihil {
namespace {

constexpr std::uint8_t kParametersCommand = 0x20, kMotionCommand = 0x21, kParametersReply = 0x80,
                       kMotionReply = 0x81;
constexpr std::uint8_t kCommandBytes = 52, kReplyBytes = 56;
constexpr std::int64_t kTelemetry_ns = 5'000'000;
constexpr std::uint32_t kReset = 1, kTelemetry = 2;
// Of a command for motion.
constexpr BusField<std::uint8_t> kTypeField{.at = 0}, kKindField{.at = 12};
constexpr BusField<std::uint32_t> kFlagsField{.at = 8};
constexpr BusField<float> kSetpointField{.at = 16};
enum Kind : std::uint8_t { kOpenLoop = 0, kVelocity = 1, kTorque = 2, kBoth = 3 };
constexpr std::size_t kGains = 8;
constexpr std::size_t kTimeRow = 0, kClampRow = 9;  // rows of the update mask; the gains lie between

// The open-loop fit of the firmware (duty of its 24 V supply), and where it begins.
double open_loop_duty(double omega_rad_s) {
  if (std::abs(omega_rad_s) < 4.0) return 0.0;
  const double offset = omega_rad_s >= 0.0 ? -0.0057431 : 0.0057431;
  return std::clamp(2.0 * (0.00144873 * omega_rad_s + offset), -1.0, 1.0);
}

struct Motor {
  bool commanded = false;
  bool telemetry = false;
  Kind kind = kOpenLoop;
  double setpoint = 0;
  std::int64_t set_ns = 0;
  std::uint32_t time_s = 0;
  // velocity p i d i_max, torque p i d i_max: what the running binary reads back
  std::array<float, kGains> gains{5.5F, 8.0F, 0.1F, 20.0F, 1.0F, 0.0F, 0.0F, 0.0F};
  std::uint16_t clamp = 0;
};

class AteamUart2025 final : public MotorBus {
 public:
  explicit AteamUart2025(const MotorBusContext& context) : c_(context) {}
  BusVerdict receive(const BusFrame& frame, std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;

 private:
  BusVerdict motion(Motor& motor, const BusFrame& frame, std::int64_t now_ns);
  BusVerdict parameters(std::uint32_t line, const BusFrame& frame);
  double control(std::size_t m, std::int64_t now_ns);
  void say_motion(std::size_t m, double setpoint);

  MotorBusContext c_;
  std::array<Motor, kWheels> motors_{};
};

BusVerdict AteamUart2025::receive(const BusFrame& f, std::int64_t now_ns) {
  if (f.id >= kWheels) return BusVerdict::kNotOurs;
  if (f.size != kCommandBytes) return BusVerdict::kLength;
  if (kTypeField.get(f) == kMotionCommand) return motion(motors_[f.id], f, now_ns);
  if (kTypeField.get(f) == kParametersCommand) return parameters(f.id, f);
  return BusVerdict::kUnknownCommand;
}

BusVerdict AteamUart2025::motion(Motor& motor, const BusFrame& f, std::int64_t now_ns) {
  if (kKindField.get(f) > kBoth) return BusVerdict::kUnsupported;
  const float setpoint = kSetpointField.get(f);
  if (!std::isfinite(setpoint)) return BusVerdict::kNotFinite;
  const std::uint32_t flags = kFlagsField.get(f);
  if ((flags & kReset) != 0) {
    motor = Motor{};
    return BusVerdict::kOk;
  }
  motor.telemetry = (flags & kTelemetry) != 0;
  motor.kind = static_cast<Kind>(kKindField.get(f));
  motor.setpoint = setpoint;
  motor.set_ns = now_ns;
  motor.commanded = true;
  return BusVerdict::kOk;
}

BusVerdict AteamUart2025::parameters(std::uint32_t line, const BusFrame& f) {
  Motor& motor = motors_[line];
  const std::uint32_t which = get_u32(f, 8);
  for (std::size_t i = 0; i < kGains; ++i) {
    if (!std::isfinite(get_f32(f, 16 + 4 * i))) return BusVerdict::kNotFinite;
  }
  if ((which >> kTimeRow & 1U) != 0) motor.time_s = get_u32(f, 12);
  for (std::size_t i = 0; i < kGains; ++i) {
    if ((which >> (i + 1) & 1U) != 0) motor.gains[i] = get_f32(f, 16 + 4 * i);
  }
  if ((which >> kClampRow & 1U) != 0) motor.clamp = get_u16(f, 48);
  BusFrame reply = can_frame(line, kReplyBytes);
  reply.data[0] = kParametersReply;
  reply.data[9] = 1;  // version 0.1.0
  put_u32(reply, 12, motor.time_s);
  for (std::size_t i = 0; i < kGains; ++i) put_f32(reply, 16 + 4 * i, motor.gains[i]);
  put_u16(reply, 48, motor.clamp);
  c_.out.push(reply);
  return BusVerdict::kOk;
}

// Gives the set-point that is in force.
double AteamUart2025::control(std::size_t m, std::int64_t now_ns) {
  Motor& motor = motors_[m];
  MotorAxis& axis = c_.axes[m];
  const double age_s = static_cast<double>(now_ns - motor.set_ns) * 1e-9;
  if (motor.commanded && c_.setup.watchdog_s > 0.0 && age_s > c_.setup.watchdog_s) {
    motor.commanded = false;
    ++timeouts_;
  }
  if (!motor.commanded) {
    axis.coast();
    return 0.0;
  }
  if (motor.kind == kOpenLoop) {
    axis.set_duty(open_loop_duty(motor.setpoint));
  } else if (motor.kind == kTorque) {
    axis.set_torque(motor.setpoint);
  } else {
    axis.set_speed(motor.setpoint, 0.0);
  }
  return motor.setpoint;
}

void AteamUart2025::say_motion(std::size_t m, double setpoint) {
  const MotorAxis& axis = c_.axes[m];
  const Kind kind = motors_[m].kind;
  const double omega_rad_s = axis.omega_shaft_rad_s();
  BusFrame f = can_frame(static_cast<std::uint32_t>(m), kReplyBytes);
  f.data[0] = kMotionReply;
  put_f32(f, 12, setpoint);
  put_f32(f, 16, setpoint);
  put_u32(f, 20, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(omega_rad_s, -1e6, 1e6))));
  put_f32(f, 24, omega_rad_s);
  put_f32(f, 28, kind == kVelocity || kind == kBoth ? setpoint - omega_rad_s : 0.0);
  put_f32(f, 32, axis.duty_ratio());
  put_f32(f, 36, axis.torque_demand_Nm());
  put_f32(f, 40, axis.current_A());
  put_f32(f, 44, axis.torque_shaft_Nm());
  put_f32(f, 48, axis.torque_demand_Nm() - axis.torque_shaft_Nm());
  put_f32(f, 52, axis.torque_demand_Nm());
  c_.out.push(f);
}

void AteamUart2025::tick(std::int64_t now_ns) {
  for (std::size_t m = 0; m < kWheels; ++m) {
    const double setpoint = control(m, now_ns);
    if (motors_[m].telemetry && now_ns % kTelemetry_ns == 0) say_motion(m, setpoint);
  }
}

std::unique_ptr<MotorBus> make(const MotorBusContext& context) {
  return std::make_unique<AteamUart2025>(context);
}

constexpr MotorBusKind kKind{
    .id = "ateam-uart-2025",
    .title = "SSL A-Team wheel motor controllers of 2025, a UART each",
    .carrier = BusCarrier::kUart,
    .bit_rate = 2'000'000,
    .data_bit_rate = 0,
    .default_first_id = -1,
    .max_first_id = -1,
    .default_watchdog_s = 0.1,
    .even_parity = true,
    .make = make,
};

}  // namespace

const MotorBusKind& motor_bus_ateam_uart_2025() { return kKind; }

}  // namespace omnihil
