// SSL A-Team wheel motor controllers, 2026 (current-controlled): a UART per motor, one struct per burst.
//
//   to the motor  20 bytes: 0 type (20h parameter, 21h motion), 4 crc (0, unchecked), then
//     motion      8 flags (1 reset, 2 telemetry, 4 enable, 8 calibrate current),
//                 12 kind (0 off, 1 duty, 2 voltage, 3 current, 4 velocity, 5 velocity and current),
//                 14 int16 current mA, 16 float set-point (duty, V or rad/s)
//     parameter   8 id, 9 operation (0 read, 1 write), 10 direction (0 command, 1 reply), 12 four bytes of value
//   from it       68 bytes: 0 type (80h, 81h), 1 sequence, 4 time ms, 8 sixty bytes of telemetry
//
// Source: SSL A-Team packet layout of 2026 (transcribed; the binary was not run). Set-points of kind 5: the
// velocity loop with the current as feed-forward, a guess. Telemetry every 5 ms and the time-out of 100 ms
// are those of 2025, a guess, too. Line m is motor m: front left, back left, back right, front right. Cannot:
// as ateam_uart_2025.cc; the 20 current samples of a telemetry struct are the one mean current.
#include <algorithm>
#include <cmath>

#include "firmware_iface/motor_bus/motor_bus.h"

namespace omnihil {
namespace {

constexpr std::uint8_t kParameterCommand = 0x20, kMotionCommand = 0x21, kParameterReply = 0x80,
                       kMotionReply = 0x81;
constexpr std::uint8_t kCommandBytes = 20, kReplyBytes = 68;
constexpr std::int64_t kTelemetry_ns = 5'000'000, kMs_ns = 1'000'000;
constexpr std::uint32_t kReset = 1, kTelemetry = 2, kEnable = 4;
enum Kind : std::uint8_t {
  kOff = 0,
  kDuty = 1,
  kVoltage = 2,
  kCurrent = 3,
  kVelocity = 4,
  kVelocityCurrent = 5
};
constexpr std::uint8_t kParameters = 4;  // P, I, error limit, anti-jitter
constexpr std::uint8_t kImageHash = 100;
constexpr int kCurrentSamples = 20;

std::uint16_t milli(double value) {
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::clamp(1000.0 * value, -32768.0, 32767.0)));
}

struct Motor {
  bool commanded = false, telemetry = false;
  Kind kind = kOff;
  double setpoint = 0, current_A = 0;
  std::int64_t set_ns = 0;
  std::array<std::uint32_t, kParameters> parameters{};
  std::uint8_t sequence = 0;
};

class AteamUart2026 final : public MotorBus {
 public:
  explicit AteamUart2026(const MotorBusContext& context) : c_(context) {}
  BusVerdict receive(const BusFrame& frame, std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;

 private:
  BusVerdict motion(Motor& motor, const BusFrame& frame, std::int64_t now_ns);
  BusVerdict parameter(std::uint32_t line, const BusFrame& frame, std::int64_t now_ns);
  void control(std::size_t m, std::int64_t now_ns);
  BusFrame reply(std::uint32_t line, std::uint8_t type, std::int64_t now_ns);
  void say_motion(std::size_t m, std::int64_t now_ns);

  MotorBusContext c_;
  std::array<Motor, kWheels> motors_{};
};

BusVerdict AteamUart2026::receive(const BusFrame& f, std::int64_t now_ns) {
  if (f.id >= kWheels) return BusVerdict::kNotOurs;
  if (f.size != kCommandBytes) return BusVerdict::kLength;
  if (f.data[0] == kMotionCommand) return motion(motors_[f.id], f, now_ns);
  if (f.data[0] == kParameterCommand) return parameter(f.id, f, now_ns);
  return BusVerdict::kUnknownCommand;
}

BusVerdict AteamUart2026::motion(Motor& motor, const BusFrame& f, std::int64_t now_ns) {
  if (f.data[12] > kVelocityCurrent) return BusVerdict::kUnsupported;
  const float setpoint = get_f32(f, 16);
  if (!std::isfinite(setpoint)) return BusVerdict::kNotFinite;
  const std::uint32_t flags = get_u32(f, 8);
  if ((flags & kReset) != 0) {
    motor = Motor{};
    return BusVerdict::kOk;
  }
  motor.telemetry = (flags & kTelemetry) != 0;
  motor.kind = (flags & kEnable) != 0 ? static_cast<Kind>(f.data[12]) : kOff;
  motor.setpoint = setpoint;
  motor.current_A = 1e-3 * get_i16(f, 14);
  motor.set_ns = now_ns;
  motor.commanded = true;
  return BusVerdict::kOk;
}

BusVerdict AteamUart2026::parameter(std::uint32_t line, const BusFrame& f, std::int64_t now_ns) {
  const std::uint8_t id = f.data[8], operation = f.data[9];
  if (operation > 1) return BusVerdict::kUnknownCommand;
  if (id >= kParameters && !(id == kImageHash && operation == 0)) return BusVerdict::kUnsupported;
  Motor& motor = motors_[line];
  if (operation == 1) motor.parameters[id] = get_u32(f, 12);
  BusFrame answer = reply(line, kParameterReply, now_ns);
  answer.data[8] = id;
  answer.data[9] = operation;
  answer.data[10] = 1;
  put_u32(answer, 12, id < kParameters ? motor.parameters[id] : 0);
  c_.out.push(answer);
  return BusVerdict::kOk;
}

void AteamUart2026::control(std::size_t m, std::int64_t now_ns) {
  Motor& motor = motors_[m];
  MotorAxis& axis = c_.axes[m];
  const double age_s = static_cast<double>(now_ns - motor.set_ns) * 1e-9;
  if (motor.commanded && c_.setup.watchdog_s > 0.0 && age_s > c_.setup.watchdog_s) {
    motor.commanded = false;
    ++timeouts_;
  }
  if (!motor.commanded) return axis.coast();
  switch (motor.kind) {
    case kOff:
      return axis.coast();
    case kDuty:
      return axis.set_duty(motor.setpoint);
    case kVoltage:
      return axis.set_voltage(motor.setpoint);
    case kCurrent:
      return axis.set_current(motor.current_A);
    case kVelocity:
      return axis.set_speed(motor.setpoint, 0.0);
    case kVelocityCurrent:
      return axis.set_speed(motor.setpoint, motor.current_A * axis.torque_shaft_Nm_per_A());
  }
}

BusFrame AteamUart2026::reply(std::uint32_t line, std::uint8_t type, std::int64_t now_ns) {
  BusFrame f = can_frame(line, kReplyBytes);
  f.data[0] = type;
  f.data[1] = motors_[line].sequence++;
  put_u32(f, 4, static_cast<std::uint32_t>(now_ns / kMs_ns));
  return f;
}

void AteamUart2026::say_motion(std::size_t m, std::int64_t now_ns) {
  const MotorAxis& axis = c_.axes[m];
  const Motor& motor = motors_[m];
  const double omega_rad_s = axis.omega_shaft_rad_s();
  const bool speed = motor.kind == kVelocity || motor.kind == kVelocityCurrent;
  BusFrame f = reply(static_cast<std::uint32_t>(m), kMotionReply, now_ns);
  f.data[10] = motor.kind;
  put_u16(f, 12, static_cast<std::uint16_t>(std::clamp(1000.0 * axis.bus_voltage_V(), 0.0, 65535.0)));
  put_u16(f, 14, milli(axis.duty_ratio() * axis.bus_voltage_V()));
  put_u16(f, 16, milli(axis.current_demand_A()));
  put_u16(f, 18, milli(omega_rad_s * 1e-2));  // 0.1 rad/s
  for (std::size_t i = 0; i < kCurrentSamples; ++i) put_u16(f, 20 + 2 * i, milli(axis.current_A()));
  put_f32(f, 60, speed && motor.commanded ? motor.setpoint : 0.0);
  put_f32(f, 64, omega_rad_s);
  c_.out.push(f);
}

void AteamUart2026::tick(std::int64_t now_ns) {
  for (std::size_t m = 0; m < kWheels; ++m) {
    control(m, now_ns);
    if (motors_[m].telemetry && now_ns % kTelemetry_ns == 0) say_motion(m, now_ns);
  }
}

std::unique_ptr<MotorBus> make(const MotorBusContext& context) {
  return std::make_unique<AteamUart2026>(context);
}

constexpr MotorBusKind kKind{
    .id = "ateam-uart-2026",
    .title = "SSL A-Team wheel motor controllers of 2026, a UART each",
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

const MotorBusKind& motor_bus_ateam_uart_2026() { return kKind; }

}  // namespace omnihil
