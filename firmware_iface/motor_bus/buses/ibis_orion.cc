// ibis-ssl Orion: speed set-points to BLDC boards of two motors each, classic CAN, 11-bit ids, little-endian.
//
//   id 100 [float rev/s, float 0]                 -> motor 0; 101, 102, 103 the others
//   id 200 [float rev/s, float angle rad]         <- motor 0, every 1 ms
//   id 210 battery V   220 motor, FET degC   230 A   500 rev/s per V   <- every 16 ms
//
// Source: ibis-ssl/Orion_F303_BLDC 664a6b6 (behaviour of the running binary) and its main board's CAN table.
// Like the device: no speed loop. The voltage follows from the set-point alone,
//   V = speed / (rev/s per V), held to back-EMF +- 6 V;
// set-points are held to +- 80 rev/s and go stale after 100 ms, then 0 V. The board reads its first motor's
// set-point only when a frame of the other CAN FIFO comes (its second motor's, 110h or 010h): a lone 100h has
// no effect. 110h with first byte 3 frees the wheels for as many ms as byte 2 says; 000h frees them until
// 010h resets the boards. Motor numbers: front right, back right, back left, front left (--bus-order). Here
// both buses of the robot are one wire. Cannot: start-up self test, calibration (310h: refused), kicker,
// dribbler and power board (their ids are for others), error reports of the board, temperatures (25 C).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware_iface/motor_bus/motor_bus.h"

namespace omnihil {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kMaxRev_s = 80.0;
constexpr double kAboveBackEmf_V = 6.0;
constexpr std::int64_t kLoop_ns = 1'000'000, kSlow_ns = 16 * kLoop_ns;
constexpr double kTemperature_degC = 25.0;
constexpr std::uint32_t kSpeedId = 0x100;  // of motor 0, the others follow
constexpr BusField<float> kSpeed_rev_s{.at = 0};
constexpr double kAngleSteps = 65535.0;  // of a 16-bit angle word

struct Motor {
  double rev_s = 0;       // in force
  double held_rev_s = 0;  // in FIFO 0, not read yet
  bool held = false;
  std::int64_t set_ns = 0;
  bool stale = true;
};

class IbisBus final : public MotorBus {
 public:
  explicit IbisBus(const MotorBusContext& context) : c_(context) {}
  BusVerdict receive(const BusFrame& frame, std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;

 private:
  BusVerdict set_speed(std::size_t m, const BusFrame& frame, std::int64_t now_ns);
  void service(std::size_t board, std::int64_t now_ns);
  void control(std::size_t m, std::int64_t now_ns);
  void say(std::uint32_t id, double first, double second);
  // Of the unloaded motor: V = k omega.
  double rev_s_per_V(std::size_t m) const { return 1.0 / (kTwoPi * c_.axes[m].back_emf_V_s_per_rad()); }

  MotorBusContext c_;
  std::array<Motor, kWheels> motors_{};
  std::int64_t free_until_ns_ = 0;
  bool emergency_ = false;
};

BusVerdict IbisBus::receive(const BusFrame& f, std::int64_t now_ns) {
  if (f.fd || f.extended || f.remote) return BusVerdict::kWrongKind;
  if (f.id >= kSpeedId && f.id < kSpeedId + kWheels) return set_speed(f.id - kSpeedId, f, now_ns);
  switch (f.id) {
    case 0x010:
      if (f.size < 2) return BusVerdict::kLength;
      if (f.data[1] == 0) {
        motors_ = {};
        emergency_ = false;
      }
      break;
    case 0x110:
      if (f.size < 3) return BusVerdict::kLength;
      if (f.data[0] == 3) free_until_ns_ = now_ns + f.data[2] * kLoop_ns;
      break;
    case 0x000:
      if (f.size < 8) return BusVerdict::kLength;
      emergency_ = true;
      return BusVerdict::kOk;
    case 0x310:
      return BusVerdict::kUnsupported;
    default:
      return BusVerdict::kNotOurs;
  }
  for (std::size_t board = 0; board < 2; ++board) service(board, now_ns);
  return BusVerdict::kOk;
}

BusVerdict IbisBus::set_speed(std::size_t m, const BusFrame& f, std::int64_t now_ns) {
  if (f.size < 4) return BusVerdict::kLength;
  const double rev_s = kSpeed_rev_s.get(f);
  if (!std::isfinite(rev_s)) return BusVerdict::kNotFinite;
  motors_[m].held_rev_s = std::clamp(rev_s, -kMaxRev_s, kMaxRev_s);
  motors_[m].held = true;
  if (m % 2 == 1) service(m / 2, now_ns);
  return BusVerdict::kOk;
}

// The interrupt of FIFO 1 reads both FIFOs.
void IbisBus::service(std::size_t board, std::int64_t now_ns) {
  for (std::size_t m = 2 * board; m < 2 * board + 2; ++m) {
    Motor& motor = motors_[m];
    if (!motor.held) continue;
    motor.rev_s = motor.held_rev_s;
    motor.set_ns = now_ns;
    motor.held = motor.stale = false;
  }
}

void IbisBus::control(std::size_t m, std::int64_t now_ns) {
  Motor& motor = motors_[m];
  MotorAxis& axis = c_.axes[m];
  const double age_s = static_cast<double>(now_ns - motor.set_ns) * 1e-9;
  if (!motor.stale && c_.setup.watchdog_s > 0.0 && age_s > c_.setup.watchdog_s) {
    motor.stale = true;
    motor.rev_s = 0;
    ++timeouts_;
  }
  if (emergency_ || now_ns < free_until_ns_) return axis.coast();
  const double back_emf_V = axis.back_emf_V_s_per_rad() * axis.omega_shaft_rad_s();
  axis.set_voltage(motor.stale ? 0.0
                               : std::clamp(motor.rev_s / rev_s_per_V(m), back_emf_V - kAboveBackEmf_V,
                                            back_emf_V + kAboveBackEmf_V));
}

void IbisBus::say(std::uint32_t id, double first, double second) {
  BusFrame f = can_frame(id, 8);
  put_f32(f, 0, first);
  put_f32(f, 4, second);
  c_.out.push(f);
}

void IbisBus::tick(std::int64_t now_ns) {
  for (std::size_t m = 0; m < kWheels; ++m) {
    control(m, now_ns);
    const MotorAxis& axis = c_.axes[m];
    const auto n = static_cast<std::uint32_t>(m);
    if (now_ns % kLoop_ns == 0) {
      const double turns = axis.turns();
      const double step = std::floor((turns - std::floor(turns)) * (kAngleSteps + 1.0));
      say(0x200 + n, axis.turns_s(), step * kTwoPi / kAngleSteps);
    }
    if (now_ns % kSlow_ns == 0) {
      say(0x210 + n, axis.bus_voltage_V(), 0.0);
      say(0x220 + n, kTemperature_degC, kTemperature_degC);
      say(0x230 + n, axis.current_A(), 0.0);
      say(0x500 + n, rev_s_per_V(m), 0.0);
    }
  }
}

std::unique_ptr<MotorBus> make(const MotorBusContext& context) { return std::make_unique<IbisBus>(context); }

constexpr MotorBusKind kKind{
    .id = "ibis-orion",
    .title = "ibis-ssl Orion BLDC boards",
    .carrier = BusCarrier::kCan,
    .bit_rate = 1'000'000,
    .data_bit_rate = 0,
    .default_first_id = -1,
    .max_first_id = -1,
    .default_watchdog_s = 0.1,
    .make = make,
};

}  // namespace

const MotorBusKind& motor_bus_ibis_orion() { return kKind; }

}  // namespace omnihil
