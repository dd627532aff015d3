// mjbots moteus: registers over CAN FD, one device per motor.
//
//   id 8001 [01 00 0a  0e 20 0000c07f 00004040  11 00]   to device 1, reply to 0: position mode, velocity 3 Hz
//   id 0100 [21 00 0a]                                   its answer
//
// id = source << 8 | destination; bit 15 asks for a reply, which goes from destination to source. Frames with
// ids above 7FFh are 29-bit ones. Protocol: multiplex.h; registers and scales: mjbots moteus
// docs/protocol/registers.md; modes, time-out, trajectory and their transitions: its fw/bldc_servo_control.h.
// Like the device: writing the mode begins a new command, whose other registers fall back to their defaults;
// a position command is valid for 0.1 s unless it says otherwise, then mode 11 damps the motor until it is
// stopped; position mode follows its trajectory (50 turns/s^2 unless it says otherwise) by
//   tau = kp kp_scale (x* - x) + kd kd_scale (v* - v) + feed-forward,   |tau| <= maximum torque.
// kp and kd are what somebody tuned the device to: here they follow from the robot (motor_axis.h).
// Cannot: PWM, phase voltages, FOC angle, stay-within, stop position, fixed voltage or current, D current,
// calibration, auxiliary pins, UUID addressing, the diagnostic console and with it the configuration; of the
// faults under voltage alone. The integral term is 0. Temperature reads 25 C.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "firmware_iface/motor_bus/buses/moteus_registers.h"
#include "firmware_iface/motor_bus/motor_bus.h"

namespace omnihil {
namespace {

using namespace moteus;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kDefaultAccel_turns_s2 = 50.0;
constexpr double kUnderVoltage_V = 4.0;
constexpr double kTemperature_degC = 25.0;
constexpr std::uint32_t kUnknownRegister = 1, kNotWritable = 2;

constexpr int kFaultUnderVoltage = 40;

// The model knows it only as "not asked for": registers of functions that are not there, by their neutral
// value.
bool neutral(std::uint32_t reg, const MultiplexValue& value) {
  const double number = value.scaled(kPositionScale);
  switch (reg) {
    case 0x026:  // stop position: none
    case 0x02A:  // fixed voltage: none
    case 0x02C:  // fixed current: none
      return std::isnan(number);
    case 0x01D:  // D current
      return number == 0.0;
    case 0x02B:  // integral limit's scale; the integral gain is 0
    case 0x02D:  // ignore position bounds: there are none
      return true;
    default:
      return false;
  }
}

bool supported(std::int64_t mode) {
  return mode == kStopped || mode == kVoltageDq || mode == kCurrent || mode == kPosition ||
         mode == kZeroVelocity || mode == kBrake;
}

struct Device {
  Mode mode = kStopped;
  int fault = 0;
  Command written;  // as the registers stand
  Command active;   // as it was issued
  double timeout_left_s = 0;
  std::optional<double> control_position;  // of the trajectory; none: begins where the motor is
  double control_velocity = 0, torque = 0;
  bool trajectory_done = false;
  double p_torque = 0, d_torque = 0;
};

class MoteusBus final : public MotorBus {
 public:
  explicit MoteusBus(const MotorBusContext& context) : c_(context) { accesses_.reserve(64); }
  BusVerdict receive(const BusFrame& frame, std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;

 private:
  BusVerdict write(const RegisterAccess& access, Command& command, bool& begun, MultiplexReply& reply) const;
  void read(std::size_t m, const RegisterAccess& access, MultiplexReply& reply) const;
  bool read_measured(std::size_t m, const RegisterAccess& access, MultiplexReply& reply) const;
  void issue(Device& device) const;
  void control(std::size_t m);
  void follow_trajectory(Device& device, double position) const;
  void position_torque(std::size_t m);

  MotorBusContext c_;
  std::array<Device, kWheels> devices_{};
  std::vector<RegisterAccess> accesses_;
  std::int64_t now_ns_ = 0;
};

BusVerdict MoteusBus::receive(const BusFrame& frame, std::int64_t now_ns) {
  if (frame.remote) return BusVerdict::kWrongKind;
  const std::uint32_t to = frame.id & 0x7F, source = frame.id >> 8;
  const auto first = static_cast<std::uint32_t>(c_.setup.first_id);
  if (frame.id > 0xFFFF || (frame.id & 0x80) != 0 || to < first || to >= first + kWheels) {
    return BusVerdict::kNotOurs;
  }
  const std::size_t m = to - first;
  accesses_.clear();
  const MultiplexStatus status = read_multiplex(frame.bytes(), accesses_);
  if (status == MultiplexStatus::kTruncated) return BusVerdict::kMalformed;
  if (status == MultiplexStatus::kUnknownSubframe) return BusVerdict::kUnknownCommand;
  now_ns_ = now_ns;
  // The whole frame is understood before any of it acts.
  BusFrame answer;
  MultiplexReply reply(std::span(answer.data).first(64));
  Device& device = devices_[m];
  Command command = device.written;
  bool begun = false;
  BusVerdict verdict = BusVerdict::kOk;
  for (const RegisterAccess& access : accesses_) {
    if (!access.write) continue;
    const BusVerdict one = write(access, command, begun, reply);
    if (one != BusVerdict::kOk) verdict = one;
  }
  if (verdict == BusVerdict::kOk) {
    device.written = command;
    if (begun) issue(device);
  }
  for (const RegisterAccess& access : accesses_) {
    if (!access.write) read(m, access, reply);
  }
  if ((source & 0x80U) == 0) return verdict;
  answer.id = to << 8 | (source & 0x7FU);
  answer.extended = answer.id > 0x7FF;
  answer.fd = true;
  answer.pad = kMultiplexNop;
  answer.bitrate_switch = frame.bitrate_switch;
  answer.size = static_cast<std::uint8_t>(reply.size());
  c_.out.push(answer);
  return verdict;
}

BusVerdict MoteusBus::write(const RegisterAccess& access, Command& command, bool& begun,
                            MultiplexReply& reply) const {
  if (access.reg == 0) {
    const std::int64_t mode = access.value.whole();
    if (!supported(mode)) {
      reply.add_error(true, access.reg, kUnknownRegister);
      return BusVerdict::kUnsupported;
    }
    command = Command{};
    command.mode = static_cast<Mode>(mode);
    begun = true;
    return BusVerdict::kOk;
  }
  if (const CommandRegister* known = find_command_register(access.reg)) {
    const double value = access.value.scaled(known->scale);
    if (std::isinf(value)) return BusVerdict::kNotFinite;
    command.*known->value = value;
    return BusVerdict::kOk;
  }
  if (neutral(access.reg, access.value)) return BusVerdict::kOk;
  const bool readable = access.reg < 0x10 || (access.reg >= 0x30 && access.reg <= 0x3D);
  reply.add_error(true, access.reg, readable ? kNotWritable : kUnknownRegister);
  return BusVerdict::kUnsupported;
}

void MoteusBus::issue(Device& device) const {
  const Command& wanted = device.written;
  if (wanted.mode != kStopped && (device.mode == kFault || device.mode == kTimeout)) return;
  device.active = wanted;
  if (wanted.mode == kStopped) device.fault = 0;
  if (wanted.mode != kPosition) device.control_position.reset();
  device.mode = wanted.mode;
  if (device.active.timeout_s == 0.0) {
    device.active.timeout_s = c_.setup.watchdog_s > 0.0 ? c_.setup.watchdog_s : kNaN;
  }
  device.timeout_left_s = device.active.timeout_s;
  device.trajectory_done = false;
}

bool MoteusBus::read_measured(std::size_t m, const RegisterAccess& a, MultiplexReply& reply) const {
  const MotorAxis& axis = c_.axes[m];
  const Device& d = devices_[m];
  const auto put = [&](double value, const RegisterScale& scale) {
    reply.add(a.reg, a.value.type, value, scale);
    return true;
  };
  const double turns = axis.turns(), turns_s = axis.turns_s(), torque_Nm = axis.torque_shaft_Nm();
  switch (a.reg) {
    case 0x001:
    case 0x050:
      return put(turns, kPositionScale);
    case 0x002:
    case 0x051:
      return put(turns_s, kVelocityScale);
    case 0x003:
      return put(torque_Nm, kTorqueScale);
    case 0x004:
      return put(axis.current_A(), kCurrentScale);
    case 0x005:
      return put(0.0, kCurrentScale);
    case 0x006:
      return put(0.0, kPositionScale);
    case 0x007:
      return put(axis.duty_ratio() * axis.bus_voltage_V() * axis.current_A(), kPowerScale);
    case 0x00A:
    case 0x00E:
      return put(kTemperature_degC, kTemperatureScale);
    case 0x00D:
      return put(axis.bus_voltage_V(), kVoltageScale);
    case 0x030:
      return put(d.p_torque, kTorqueScale);
    case 0x031:
      return put(0.0, kTorqueScale);
    case 0x032:
      return put(d.d_torque, kTorqueScale);
    case 0x033:
      return put(d.active.torque_ff, kTorqueScale);
    case 0x034:
    case 0x03A:
      return put(d.torque, kTorqueScale);
    case 0x038:
      return put(d.control_position.value_or(kNaN), kPositionScale);
    case 0x039:
      return put(d.control_position ? d.control_velocity : kNaN, kVelocityScale);
    case 0x03B:
      return put(turns - d.control_position.value_or(turns), kPositionScale);
    case 0x03C:
      return put(d.control_position ? turns_s - d.control_velocity : 0.0, kVelocityScale);
    case 0x03D:
      return put(torque_Nm - d.torque, kTorqueScale);
    default:
      return false;
  }
}

void MoteusBus::read(std::size_t m, const RegisterAccess& a, MultiplexReply& reply) const {
  const Device& d = devices_[m];
  if (read_measured(m, a, reply)) return;
  if (const CommandRegister* known = find_command_register(a.reg)) {
    return reply.add(a.reg, a.value.type, d.written.*known->value, known->scale);
  }
  const auto whole = [&](std::int64_t value) { reply.add_whole(a.reg, a.value.type, value); };
  switch (a.reg) {
    case 0x000:
      return whole(d.mode);
    case 0x00B:
      return whole(d.trajectory_done ? 1 : 0);
    case 0x00C:
      return whole(1);  // home state: rotor
    case 0x00F:
      return whole(d.fault);
    case 0x058:
      return whole(3);  // encoder 0: angle and velocity
    case 0x070:
      return whole(now_ns_ / 1'000'000);
    case 0x100:
      return whole(1);  // model number
    case 0x101:
      return whole(0x0104);  // firmware 0.1.4
    case 0x102:
      return whole(5);  // register map version
    case 0x110:
      return whole(c_.setup.first_id + static_cast<std::int64_t>(m));
    case 0x120:
    case 0x121:
    case 0x122:
      return whole(0);  // serial number
    default:
      return reply.add_error(false, a.reg, kUnknownRegister);
  }
}

// The control position moves toward the commanded one (or on, where none is given) within the limits.
void MoteusBus::follow_trajectory(Device& d, double position) const {
  const Command& c = d.active;
  const double dt = c_.period_s;
  const double accel = std::isnan(c.accel_limit) ? kDefaultAccel_turns_s2
                       : c.accel_limit < 0.0     ? std::numeric_limits<double>::infinity()
                                                 : c.accel_limit;
  const bool limited = std::isfinite(accel) || c.velocity_limit >= 0.0;
  const double limit = c.velocity_limit >= 0.0 ? c.velocity_limit : std::numeric_limits<double>::infinity();
  if (!d.control_position) {
    d.control_position = position;
    d.control_velocity = 0;
  }
  const double target_velocity = std::clamp(std::isnan(c.velocity) ? 0.0 : c.velocity, -limit, limit);
  double wanted = target_velocity;
  if (!std::isnan(c.position)) {
    const double left = d.active.position - *d.control_position;
    d.active.position += target_velocity * dt;  // the target moves on
    if (!limited) {
      d.control_position = d.active.position;
      d.control_velocity = target_velocity;
      d.trajectory_done = true;
      return;
    }
    // v^2 = 2 a d, and no faster than one step can stop
    const double approach =
        std::min(std::sqrt(2.0 * std::min(accel, 1e9) * std::abs(left)), std::abs(left) / dt);
    wanted = std::clamp(target_velocity + std::copysign(approach, left), -limit, limit);
  }
  const double most = std::isfinite(accel) ? accel * dt : std::numeric_limits<double>::infinity();
  const double change = std::clamp(wanted - d.control_velocity, -most, most);
  d.control_velocity += change;
  d.control_position = *d.control_position + d.control_velocity * dt;
  d.trajectory_done = std::abs(d.control_velocity - target_velocity) < 1e-9 &&
                      (std::isnan(c.position) || std::abs(d.active.position - *d.control_position) < 1e-4);
}

void MoteusBus::position_torque(std::size_t m) {
  Device& d = devices_[m];
  MotorAxis& axis = c_.axes[m];
  follow_trajectory(d, axis.turns());
  const auto scale = [](double value) { return std::isnan(value) ? 1.0 : std::clamp(value, 0.0, 1.0); };
  const double kp = kTwoPi * axis.speed_gain_i() * scale(d.active.kp_scale);  // N m per turn
  const double kd = kTwoPi * axis.speed_gain_p() * scale(d.active.kd_scale);  // N m per turn/s
  d.p_torque = kp * (*d.control_position - axis.turns());
  d.d_torque = kd * (d.control_velocity - axis.turns_s());
  const double ff = std::isnan(d.active.torque_ff) ? 0.0 : d.active.torque_ff;
  const double most =
      std::isnan(d.active.max_torque) ? axis.torque_limit_Nm() : std::abs(d.active.max_torque);
  d.torque = std::clamp(d.p_torque + d.d_torque + ff, -most, most);
  axis.set_torque(d.torque);
}

void MoteusBus::control(std::size_t m) {
  Device& d = devices_[m];
  MotorAxis& axis = c_.axes[m];
  if (d.mode == kPosition && !std::isnan(d.timeout_left_s)) {
    d.timeout_left_s -= c_.period_s;
    if (d.timeout_left_s <= 0.0) {
      d.mode = kTimeout;
      d.control_position.reset();
      ++timeouts_;
    }
  }
  if (d.mode != kStopped && d.mode != kFault && axis.bus_voltage_V() < kUnderVoltage_V) {
    d.mode = kFault;
    d.fault = kFaultUnderVoltage;
  }
  d.torque = d.p_torque = d.d_torque = 0;
  switch (d.mode) {
    case kVoltageDq:
      return axis.set_voltage(std::isnan(d.active.q_voltage) ? 0.0 : d.active.q_voltage);
    case kCurrent:
      return axis.set_current(std::isnan(d.active.q_current) ? 0.0 : d.active.q_current);
    case kPosition:
      return position_torque(m);
    case kTimeout:
    case kZeroVelocity:
      d.torque = d.d_torque = -kTwoPi * axis.speed_gain_p() * axis.turns_s();
      return axis.set_torque(d.torque);
    case kBrake:
      return axis.brake();
    case kStopped:
    case kFault:
      break;
  }
  axis.coast();
}

void MoteusBus::tick(std::int64_t now_ns) {
  now_ns_ = now_ns;
  for (std::size_t m = 0; m < kWheels; ++m) control(m);
}

std::unique_ptr<MotorBus> make(const MotorBusContext& context) {
  return std::make_unique<MoteusBus>(context);
}

// One device from the host's side: by Q voltage, or by torque as the feed-forward of position mode without its gains, which
// the device lets go of by itself after its time-out. One frame asks and reads.
class MoteusHost final : public AxisHost {
 public:
  explicit MoteusHost(int id) : id_(static_cast<std::uint32_t>(id)) {}
  bool can(AxisDemand) const override { return true; }
  bool answers_each() const override { return true; }

  void ask(AxisDemand demand, double value, std::vector<BusFrame>& out) override {
    const bool voltage = demand == AxisDemand::kVoltage;
    say(voltage ? kVoltageDq : kPosition, out, [&](MultiplexReply& write) {
      const auto put = [&](std::uint32_t reg, double v) {
        write.add(reg, MultiplexType::kFloat, v, kRatioScale);  // floats have no scale
      };
      if (voltage) return put(kVoltageRegister, value);
      std::uint32_t reg = kPositionRegister;
      for (const double v : {kNaN, 0.0, value, 0.0, 0.0}) put(reg++, v);  // no gains: kp and kd scale
    });
    asked_ = true;
  }

  void stop(std::vector<BusFrame>& out) override {
    asked_ = false;
    say(kStopped, out, [](MultiplexReply&) {});
  }

  bool hear(const BusFrame& f) override {
    if (f.id >> 8 != id_ || f.remote) return false;
    accesses_.clear();
    if (read_multiplex_reply(f.bytes(), accesses_) != MultiplexStatus::kOk) {
      state_.trouble = "the moteus refuses what it is asked";
      return false;
    }
    std::int64_t mode = kStopped, fault = 0;
    double* const measured[] = {&state_.turns, &state_.turns_s, &state_.torque_Nm, &state_.q_current_A};
    for (const RegisterAccess& a : accesses_) {
      const std::uint32_t at = a.reg - kMeasuredRegisters;
      if (a.reg == kModeRegister) {
        mode = a.value.whole();
      } else if (at < kMeasuredCount) {
        *measured[at] = a.value.scaled(kRatioScale);
      } else if (a.reg == kBusRegister) {
        state_.bus_V = a.value.scaled(kRatioScale);
      } else if (a.reg == kFaultRegister) {
        fault = a.value.whole();
      }
    }
    state_.trouble.clear();
    if (mode == kFault || fault != 0) {
      state_.trouble = "the moteus reports fault " + std::to_string(fault);
    } else if (asked_ && mode == kTimeout) {
      state_.trouble = "the moteus had no command within its time-out";
    }
    return true;
  }

 private:
  template <class Write>
  void say(Mode mode, std::vector<BusFrame>& out, const Write& write) const {
    BusFrame f;
    f.id = 0x8000U | id_;  // from 0, with an answer
    f.extended = f.fd = f.bitrate_switch = true;
    f.pad = kMultiplexNop;
    MultiplexReply writes(std::span(f.data).first(64), MultiplexKind::kWrite);
    writes.add_whole(kModeRegister, MultiplexType::kInt8, mode);
    write(writes);
    // read: the mode as int8, four measured values and the bus as floats, the fault as int8 (multiplex.h)
    const std::uint8_t reads[] = {0x11, kModeRegister, 0x1C, kMeasuredCount, kMeasuredRegisters,
                                  0x1D, kBusRegister,  0x11, kFaultRegister};
    std::copy(std::begin(reads), std::end(reads),
              f.data.begin() + static_cast<std::ptrdiff_t>(writes.size()));
    f.size = static_cast<std::uint8_t>(writes.size() + sizeof reads);
    out.push_back(f);
  }

  std::uint32_t id_;
  bool asked_ = false;
  std::vector<RegisterAccess> accesses_;
};

std::unique_ptr<AxisHost> host(int id) { return std::make_unique<MoteusHost>(id); }

constexpr MotorBusKind kKind{
    .id = "moteus",
    .title = "mjbots moteus, registers over CAN FD",
    .carrier = BusCarrier::kCanFd,
    .bit_rate = 1'000'000,
    .data_bit_rate = 5'000'000,
    .default_first_id = 1,
    .max_first_id = 0x7E - kWheels,  // 127 is for all
    .default_watchdog_s = 0.1,
    .host = host,
    .make = make,
};

}  // namespace

const MotorBusKind& motor_bus_moteus() { return kKind; }

}  // namespace omnihil
