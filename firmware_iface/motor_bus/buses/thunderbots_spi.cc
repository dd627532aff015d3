// UBC Thunderbots' motor boards (STSPIN32F0), SPI: ten bytes each way in one transfer, a wire per motor.
//
//   to the motor  AA BB CC · sequence · opcode · four bytes (big-endian) · CRC-8/AUTOSAR of the first nine
//   from it       AA BB CC · sequence · what it holds · two int16 (big-endian) · CRC
//
// Opcodes: 0 none, 1 speed (enable, int16 rpm), 2 torque (enable, int16 counts), 3 what answers hold (1 speed and
// faults, 2 iq id, 3 vq vd, 4 phase current and voltage, 5 iq and wanted, 6 id and wanted, 7 speed and wanted),
// 4 to 6 gains, 7 and 8 feed-forward. Two buffers take turns, so the answer to a transfer leaves with the second one
// after it; a transfer that is no frame, or whose sequence is neither the last one nor the next, is answered by
// sequence 0. Line m is motor m: front left, front right, back left, back right.
//
// Source: UBC-Thunderbots/MDv6_Firmware (Src/interface.c, frames of ten bytes), Software 0139338. Guesses: counts of
// current and voltage are mA and mV (1 count of torque is 1 mA of q current). Gains and feed-forward are taken and
// have no effect; id and vd are 0, no fault is ever set. No watchdog in the sources: none here unless asked for.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "firmware_iface/motor_bus/motor_bus.h"

namespace omnihil {
namespace {

constexpr std::uint8_t kBytes = 10;
constexpr std::array<std::uint8_t, 3> kDelimiter{0xAA, 0xBB, 0xCC};
enum At : std::size_t { kSequence = 3, kCode = 4, kData = 5, kCrc = 9 };
enum Opcode : std::uint8_t { kNoOp = 0, kSpeed = 1, kTorque = 2, kResponseType = 3, kLastOpcode = 8 };
enum Response : std::uint8_t {
  kSpeedFaults = 1,
  kIqId = 2,
  kVqVd = 3,
  kPhase = 4,
  kIqRef = 5,
  kIdRef = 6,
  kSpeedRef = 7
};
constexpr double kRpmPerRad_s = 30.0 / std::numbers::pi;
constexpr double kAmperePerCount = 1e-3, kVoltPerCount = 1e-3;  // guesses, see above

// CRC-8/AUTOSAR: polynomial 2F, start FF, inverted at the end.
std::uint8_t crc(const BusFrame& frame) {
  unsigned rest = 0xFF;
  for (std::size_t i = 0; i < kCrc; ++i) {
    rest ^= frame.data[i];
    for (int bit = 0; bit < 8; ++bit) rest = (rest << 1 ^ ((rest & 0x80) != 0 ? 0x2F : 0)) & 0xFF;
  }
  return static_cast<std::uint8_t>(rest ^ 0xFF);
}

std::int16_t get_word(const BusFrame& frame, std::size_t at) {
  return static_cast<std::int16_t>(frame.data[at] << 8 | frame.data[at + 1]);
}
void put_word(BusFrame& frame, std::size_t at, double value) {
  const auto word =
      static_cast<std::uint16_t>(static_cast<std::int16_t>(std::clamp(value, -32768.0, 32767.0)));
  frame.data[at] = static_cast<std::uint8_t>(word >> 8);
  frame.data[at + 1] = static_cast<std::uint8_t>(word);
}

struct Motor {
  bool enabled = false;
  Opcode kind = kSpeed;
  double target = 0.0;  // rpm, or counts of torque
  std::uint8_t response = kSpeedFaults;
  std::uint8_t sequence = 0;
  std::int64_t set_ns = 0;
  std::array<BusFrame, 2> next{};  // what leaves with the next transfers
  bool started = false;
};

class ThunderbotsSpi final : public MotorBus {
 public:
  explicit ThunderbotsSpi(const MotorBusContext& context) : c_(context) {}
  BusVerdict receive(const BusFrame& frame, std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;

 private:
  BusVerdict take(Motor& motor, const BusFrame& frame, std::int64_t now_ns);
  BusFrame answer(std::uint32_t line, std::uint8_t sequence) const;

  MotorBusContext c_;
  std::array<Motor, kWheels> motors_{};
};

BusVerdict ThunderbotsSpi::receive(const BusFrame& f, std::int64_t now_ns) {
  if (f.id >= kWheels) return BusVerdict::kNotOurs;
  if (f.size != kBytes) return BusVerdict::kLength;
  Motor& motor = motors_[f.id];
  if (!motor.started) motor.next.fill(answer(f.id, 0));
  motor.started = true;
  c_.out.push(motor.next[0]);
  motor.next[0] = motor.next[1];
  const bool whole =
      std::equal(kDelimiter.begin(), kDelimiter.end(), f.data.begin()) && f.data[kCrc] == crc(f);
  const std::uint8_t sequence = f.data[kSequence];
  const bool in_order =
      sequence == motor.sequence || sequence == static_cast<std::uint8_t>(motor.sequence + 1);
  if (!whole || !in_order) {
    motor.next[1] = answer(f.id, 0);
    return whole ? BusVerdict::kUnsupported : BusVerdict::kMalformed;
  }
  motor.sequence = sequence;
  const BusVerdict verdict = take(motor, f, now_ns);
  motor.next[1] = answer(f.id, sequence);
  return verdict;
}

BusVerdict ThunderbotsSpi::take(Motor& motor, const BusFrame& f, std::int64_t now_ns) {
  const std::uint8_t opcode = f.data[kCode];
  if (opcode > kLastOpcode) return BusVerdict::kUnknownCommand;
  if (opcode == kResponseType) {
    if (f.data[kData] < kSpeedFaults || f.data[kData] > kSpeedRef) return BusVerdict::kUnsupported;
    motor.response = f.data[kData];
  }
  if (opcode != kSpeed && opcode != kTorque) return BusVerdict::kOk;
  motor.enabled = f.data[kData] != 0;
  motor.kind = static_cast<Opcode>(opcode);
  motor.target = get_word(f, kData + 1);
  motor.set_ns = now_ns;
  return BusVerdict::kOk;
}

BusFrame ThunderbotsSpi::answer(std::uint32_t line, std::uint8_t sequence) const {
  const Motor& motor = motors_[line];
  const MotorAxis& axis = c_.axes[line];
  BusFrame f = can_frame(line, kBytes);
  std::copy(kDelimiter.begin(), kDelimiter.end(), f.data.begin());
  f.data[kSequence] = sequence;
  f.data[kCode] = motor.response;
  const double rpm = axis.omega_shaft_rad_s() * kRpmPerRad_s;
  const double iq = axis.current_A() / kAmperePerCount;
  const double vq = axis.duty_ratio() * axis.bus_voltage_V() / kVoltPerCount;
  const bool by_speed = motor.kind == kSpeed;
  const auto say = [&](double first, double second) {
    put_word(f, kData, first);
    put_word(f, kData + 2, second);
  };
  switch (motor.response) {
    case kIqId:
      say(iq, 0.0);
      break;
    case kVqVd:
      say(vq, 0.0);
      break;
    case kPhase:
      say(std::abs(iq), std::abs(vq));
      break;
    case kIqRef:
      say(iq, axis.current_demand_A() / kAmperePerCount);
      break;
    case kIdRef:
      say(0.0, 0.0);
      break;
    case kSpeedRef:
      say(rpm, by_speed && motor.enabled ? motor.target : 0.0);
      break;
    default:
      say(rpm, 0.0);
  }
  f.data[kCrc] = crc(f);
  return f;
}

void ThunderbotsSpi::tick(std::int64_t now_ns) {
  for (std::size_t m = 0; m < kWheels; ++m) {
    Motor& motor = motors_[m];
    const double age_s = static_cast<double>(now_ns - motor.set_ns) * 1e-9;
    if (motor.enabled && c_.setup.watchdog_s > 0.0 && age_s > c_.setup.watchdog_s) {
      motor.enabled = false;
      ++timeouts_;
    }
    if (!motor.enabled) {
      c_.axes[m].coast();
    } else if (motor.kind == kSpeed) {
      c_.axes[m].set_speed(motor.target / kRpmPerRad_s, 0.0);
    } else {
      c_.axes[m].set_current(motor.target * kAmperePerCount);
    }
  }
}

std::unique_ptr<MotorBus> make(const MotorBusContext& context) {
  return std::make_unique<ThunderbotsSpi>(context);
}

constexpr MotorBusKind kKind{
    .id = "thunderbots-spi",
    .title = "UBC Thunderbots' motor boards, an SPI transfer each",
    .carrier = BusCarrier::kUart,
    .bit_rate = 500'000,
    .data_bit_rate = 0,
    .default_first_id = -1,
    .max_first_id = -1,
    .default_watchdog_s = 0.0,
    .make = make,
};

}  // namespace

const MotorBusKind& motor_bus_thunderbots_spi() { return kKind; }

}  // namespace omnihil
