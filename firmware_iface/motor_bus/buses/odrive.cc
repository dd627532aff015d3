// ODrive "CANSimple": one node per motor, classic CAN, id = node << 5 | command, little-endian.
//
//   node 0, closed loop, 5 turns/s:  id 007 [08 00 00 00]   id 00D [00 00 A0 40 00 00 00 00]
//   its answers, unasked:            id 001 every 100 ms, id 009 [turns, turns/s] every 10 ms
//
// Source: ODrive documentation 0.6, "CAN Protocol" and the enumeration ODrive.Error; ODrive 0.5.5
// docs/can-protocol.rst (cyclic rates) and its axis watchdog (fed by every message to the axis).
// Like the device: idle after power-up, setpoints have no effect unless in closed loop; no watchdog unless it
// is configured (setup.watchdog_s); an estop or an expired watchdog disarms until Clear_Errors. Configured
// here: velocity control, pass-through, no velocity limit, since CANSimple cannot store a configuration.
// The host's end (axis_host.h) drives a node by torque.
// Cannot: calibration and other axis states, input filters and ramps, trajectories, anticogging, parameter
// access (RxSdo), overspeed errors, CAN FD, 29-bit ids. Iq is the torque-equivalent DC current; temperatures
// read 25 C.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "firmware_iface/motor_bus/motor_bus.h"

namespace omnihil {
namespace {

enum Command : std::uint32_t {
  kGetVersion = 0x00,
  kHeartbeat = 0x01,
  kEstop = 0x02,
  kGetError = 0x03,
  kSetAxisState = 0x07,
  kGetEncoderEstimates = 0x09,
  kSetControllerMode = 0x0B,
  kSetInputPos = 0x0C,
  kSetInputVel = 0x0D,
  kSetInputTorque = 0x0E,
  kSetLimits = 0x0F,
  kGetIq = 0x14,
  kGetTemperature = 0x15,
  kReboot = 0x16,
  kGetBusVoltageCurrent = 0x17,
  kClearErrors = 0x18,
  kSetAbsolutePosition = 0x19,
  kSetPosGain = 0x1A,
  kSetVelGains = 0x1B,
  kGetTorques = 0x1C,
  kGetPowers = 0x1D,
};
enum AxisState : std::uint8_t { kIdle = 1, kClosedLoop = 8 };
enum ControlMode : std::uint32_t { kTorqueControl = 1, kVelocityControl = 2, kPositionControl = 3 };
constexpr std::uint32_t kPassThrough = 1;
constexpr std::uint32_t kWatchdogExpired = 0x0100'0000, kEstopRequested = 0x0200'0000;
constexpr std::uint8_t kSuccess = 0, kDisarmed = 3;
constexpr std::int64_t kHeartbeat_ns = 100'000'000, kEncoder_ns = 10'000'000;
constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kTemperature_degC = 25.0;
constexpr double kPosGain = 20.0;           // (turn/s)/turn, the device's default
constexpr double kFeedforwardStep = 0.001;  // of Set_Input_Pos: turns/s and N m per count

struct Node {
  AxisState state = kIdle;
  std::uint32_t control_mode = kVelocityControl;
  std::uint32_t active_errors = 0, disarm_reason = 0;
  std::uint8_t result = kSuccess;
  double input_turns = 0, input_turns_s = 0, input_Nm = 0;
  double limit_turns_s = std::numeric_limits<double>::infinity();
  double pos_gain = kPosGain;
  double offset_turns = 0;  // Set_Absolute_Position
  std::int64_t fed_ns = 0;
};

// Bytes that a command to the axis has at least; longer ones are padded.
int bytes_of(std::uint32_t command) {
  switch (command) {
    case kEstop:
    case kClearErrors:
    case kReboot:
      return 0;
    case kSetAxisState:
    case kSetInputTorque:
    case kSetAbsolutePosition:
    case kSetPosGain:
      return 4;
    case kSetControllerMode:
    case kSetInputPos:
    case kSetInputVel:
    case kSetLimits:
    case kSetVelGains:
      return 8;
    default:
      return -1;
  }
}

// How many floats it begins with.
int floats_of(std::uint32_t command) {
  switch (command) {
    case kSetInputVel:
    case kSetLimits:
    case kSetVelGains:
      return 2;
    case kSetInputPos:
    case kSetInputTorque:
    case kSetAbsolutePosition:
    case kSetPosGain:
      return 1;
    default:
      return 0;
  }
}

class OdriveBus final : public MotorBus {
 public:
  explicit OdriveBus(const MotorBusContext& context) : c_(context) {}
  BusVerdict receive(const BusFrame& frame, std::int64_t now_ns) override;
  void tick(std::int64_t now_ns) override;

 private:
  BusVerdict command(std::size_t m, std::uint32_t command, const BusFrame& frame);
  BusVerdict set_state(std::size_t m, std::uint32_t state);
  bool answer(std::size_t m, std::uint32_t command);
  void disarm(Node& node, std::uint32_t error);
  void control(std::size_t m, std::int64_t now_ns);
  double turns(std::size_t m) const { return c_.axes[m].turns() - nodes_[m].offset_turns; }

  MotorBusContext c_;
  std::array<Node, kWheels> nodes_{};
};

BusVerdict OdriveBus::receive(const BusFrame& frame, std::int64_t now_ns) {
  if (frame.fd || frame.extended) return BusVerdict::kWrongKind;
  const std::uint32_t id = frame.id >> 5, cmd = frame.id & 0x1F;
  const auto first = static_cast<std::uint32_t>(c_.setup.first_id);
  if (id < first || id >= first + kWheels) return BusVerdict::kNotOurs;
  const std::size_t m = id - first;
  if (frame.remote) {
    if (!answer(m, cmd)) return BusVerdict::kUnknownCommand;
    nodes_[m].fed_ns = now_ns;
    return BusVerdict::kOk;
  }
  const int bytes = bytes_of(cmd);
  if (bytes < 0) return BusVerdict::kUnknownCommand;
  if (frame.size < bytes) return BusVerdict::kLength;
  for (int i = 0; i < floats_of(cmd); ++i) {
    if (!std::isfinite(get_f32(frame, 4 * static_cast<std::size_t>(i)))) return BusVerdict::kNotFinite;
  }
  const BusVerdict verdict = command(m, cmd, frame);
  if (verdict == BusVerdict::kOk) nodes_[m].fed_ns = now_ns;
  return verdict;
}

BusVerdict OdriveBus::set_state(std::size_t m, std::uint32_t state) {
  Node& node = nodes_[m];
  if (state != kIdle && state != kClosedLoop) return BusVerdict::kUnsupported;
  if (state == kClosedLoop && node.active_errors != 0) {
    node.result = kDisarmed;
    return BusVerdict::kOk;
  }
  if (state == kClosedLoop && node.state != kClosedLoop) {
    node.disarm_reason = 0;
    node.input_turns = turns(m);
    node.input_turns_s = node.input_Nm = 0;
  }
  node.state = static_cast<AxisState>(state);
  node.result = kSuccess;
  return BusVerdict::kOk;
}

BusVerdict OdriveBus::command(std::size_t m, std::uint32_t cmd, const BusFrame& f) {
  Node& node = nodes_[m];
  MotorAxis& axis = c_.axes[m];
  switch (cmd) {
    case kEstop:
      disarm(node, kEstopRequested);
      break;
    case kSetAxisState:
      return set_state(m, get_u32(f, 0));
    case kSetControllerMode:
      if (get_u32(f, 0) < kTorqueControl || get_u32(f, 0) > kPositionControl) return BusVerdict::kUnsupported;
      if (get_u32(f, 4) != kPassThrough) return BusVerdict::kUnsupported;
      node.control_mode = get_u32(f, 0);
      break;
    case kSetInputPos:
      node.input_turns = get_f32(f, 0);
      node.input_turns_s = kFeedforwardStep * get_i16(f, 4);
      node.input_Nm = kFeedforwardStep * get_i16(f, 6);
      break;
    case kSetInputVel:
      node.input_turns_s = get_f32(f, 0);
      node.input_Nm = get_f32(f, 4);
      break;
    case kSetInputTorque:
      node.input_Nm = get_f32(f, 0);
      break;
    case kSetLimits:
      if (get_f32(f, 0) < 0.0F || get_f32(f, 4) < 0.0F) return BusVerdict::kUnsupported;
      node.limit_turns_s = get_f32(f, 0);
      axis.set_current_limit(get_f32(f, 4));
      break;
    case kReboot:
      node = Node{};
      break;
    case kClearErrors:
      node.active_errors = node.disarm_reason = 0;
      break;
    case kSetAbsolutePosition:
      node.offset_turns = axis.turns() - get_f32(f, 0);
      break;
    case kSetPosGain:
      node.pos_gain = get_f32(f, 0);
      break;
    case kSetVelGains:  // N m per turn/s, N m per turn
      axis.set_speed_gains(get_f32(f, 0) / kTwoPi, get_f32(f, 4) / kTwoPi);
      break;
    default:
      return BusVerdict::kUnknownCommand;
  }
  return BusVerdict::kOk;
}

// What the node sends of itself or when it is asked by a remote frame.
bool OdriveBus::answer(std::size_t m, std::uint32_t cmd) {
  const Node& node = nodes_[m];
  const MotorAxis& axis = c_.axes[m];
  const double power_W = axis.duty_ratio() * axis.bus_voltage_V() * axis.current_A();
  BusFrame f = can_frame(
      (static_cast<std::uint32_t>(c_.setup.first_id) + static_cast<std::uint32_t>(m)) << 5 | cmd, 8);
  const auto pair = [&f](double first, double second) {
    put_f32(f, 0, first);
    put_f32(f, 4, second);
  };
  switch (cmd) {
    case kGetVersion:
      f.data = {2, 4, 4, 58, 0, 6, 10, 0};  // protocol 2, hardware 4.4-58, firmware 0.6.10
      break;
    case kHeartbeat:
      put_u32(f, 0, node.active_errors | node.disarm_reason);
      f.data[4] = node.state;
      f.data[5] = node.result;
      f.data[6] = 1;  // no trajectory is under way
      break;
    case kGetError:
      put_u32(f, 0, node.active_errors);
      put_u32(f, 4, node.disarm_reason);
      break;
    case kGetEncoderEstimates:
      pair(turns(m), axis.turns_s());
      break;
    case kGetIq:
      pair(axis.current_demand_A(), axis.current_A());
      break;
    case kGetTemperature:
      pair(kTemperature_degC, kTemperature_degC);
      break;
    case kGetBusVoltageCurrent:
      pair(axis.bus_voltage_V(), axis.duty_ratio() * axis.current_A());
      break;
    case kGetTorques:
      pair(axis.torque_demand_Nm(), axis.torque_shaft_Nm());
      break;
    case kGetPowers:
      pair(power_W, axis.torque_shaft_Nm() * axis.omega_shaft_rad_s());
      break;
    default:
      return false;
  }
  c_.out.push(f);
  return true;
}

void OdriveBus::disarm(Node& node, std::uint32_t error) {
  node.active_errors |= error;
  node.disarm_reason |= error;
  node.state = kIdle;
  node.result = kDisarmed;
}

void OdriveBus::control(std::size_t m, std::int64_t now_ns) {
  Node& node = nodes_[m];
  MotorAxis& axis = c_.axes[m];
  const double watchdog_s = c_.setup.watchdog_s;
  if (node.state == kClosedLoop && watchdog_s > 0.0 &&
      static_cast<double>(now_ns - node.fed_ns) * 1e-9 > watchdog_s) {
    ++timeouts_;
    disarm(node, kWatchdogExpired);
  }
  if (node.state != kClosedLoop) return axis.coast();
  if (node.control_mode == kTorqueControl) return axis.set_torque(node.input_Nm);
  double turns_s = node.input_turns_s;
  if (node.control_mode == kPositionControl) turns_s += node.pos_gain * (node.input_turns - turns(m));
  turns_s = std::clamp(turns_s, -node.limit_turns_s, node.limit_turns_s);
  axis.set_speed(kTwoPi * turns_s, node.input_Nm);
}

void OdriveBus::tick(std::int64_t now_ns) {
  for (std::size_t m = 0; m < kWheels; ++m) {
    control(m, now_ns);
    if (now_ns % kHeartbeat_ns == 0) answer(m, kHeartbeat);
    if (now_ns % kEncoder_ns == 0) answer(m, kGetEncoderEstimates);
  }
}

std::unique_ptr<MotorBus> make(const MotorBusContext& context) {
  return std::make_unique<OdriveBus>(context);
}

// One node from the host's side, by torque. A sample is whole when estimates, current and bus have been answered since it was
// asked for; estimates that the node sends of itself in between are passed over.
class OdriveHost final : public AxisHost {
 public:
  explicit OdriveHost(int node) : node_(static_cast<std::uint32_t>(node)) {}
  bool can(AxisDemand demand) const override { return demand == AxisDemand::kTorque; }
  bool answers_each() const override { return false; }

  void ask(AxisDemand, double value, std::vector<BusFrame>& out) override {
    if (!armed_) {
      say_two(kSetControllerMode, kTorqueControl, kPassThrough, out);
      say_one(kSetAxisState, kClosedLoop, out);
      heartbeats_ = 0;
    }
    armed_ = true;
    BusFrame f = frame(kSetInputTorque, 4);
    put_f32(f, 0, value);
    out.push_back(f);
    query(out);
  }

  void stop(std::vector<BusFrame>& out) override {
    BusFrame f = frame(kSetInputTorque, 4);
    put_f32(f, 0, 0.0);
    out.push_back(f);
    say_one(kSetAxisState, kIdle, out);
    armed_ = false;
    query(out);
  }

  bool hear(const BusFrame& f) override {
    if (f.fd || f.extended || f.remote || f.id >> 5 != node_ || f.size < 8) return false;
    switch (f.id & 0x1F) {
      case kHeartbeat:
        heartbeat(f);
        return false;
      case kGetEncoderEstimates:
        if ((wanted_ & kEstimates) == 0) return false;
        state_.turns = get_f32(f, 0);
        state_.turns_s = get_f32(f, 4);
        return came(kEstimates);
      case kGetIq:
        state_.q_current_A = get_f32(f, 4);
        return came(kCurrent);
      case kGetBusVoltageCurrent:
        state_.bus_V = get_f32(f, 0);
        return came(kBus);
      default:
        return false;
    }
  }

 private:
  enum : unsigned { kEstimates = 1, kCurrent = 2, kBus = 4 };

  BusFrame frame(std::uint32_t command, std::uint8_t size) const {
    return can_frame(node_ << 5 | command, size);
  }
  void say_one(std::uint32_t command, std::uint32_t value, std::vector<BusFrame>& out) const {
    BusFrame f = frame(command, 4);
    put_u32(f, 0, value);
    out.push_back(f);
  }
  void say_two(std::uint32_t command, std::uint32_t first, std::uint32_t second,
               std::vector<BusFrame>& out) const {
    BusFrame f = frame(command, 8);
    put_u32(f, 0, first);
    put_u32(f, 4, second);
    out.push_back(f);
  }
  void query(std::vector<BusFrame>& out) {
    for (const std::uint32_t command : {kGetEncoderEstimates, kGetIq, kGetBusVoltageCurrent}) {
      BusFrame f = frame(command, 0);
      f.remote = true;
      out.push_back(f);
    }
    wanted_ = kEstimates | kCurrent | kBus;
  }
  bool came(unsigned which) {
    const bool last = wanted_ == which;
    wanted_ &= ~which;
    return last;
  }
  // The first heartbeat after arming may be from before it.
  void heartbeat(const BusFrame& f) {
    const std::uint32_t errors = get_u32(f, 0);
    heartbeats_ = std::min(heartbeats_ + 1, 2);
    state_.trouble.clear();
    if (errors != 0) {
      constexpr char kHex[] = "0123456789ABCDEF";
      state_.trouble = "the ODrive reports error 0x";
      for (int at = 28; at >= 0; at -= 4) state_.trouble += kHex[errors >> at & 0xFU];
    } else if (armed_ && heartbeats_ > 1 && f.data[4] != kClosedLoop) {
      state_.trouble = "the ODrive does not go into closed loop control";
    }
  }

  std::uint32_t node_;
  bool armed_ = false;
  unsigned wanted_ = 0;
  int heartbeats_ = 0;
};

std::unique_ptr<AxisHost> host(int id) { return std::make_unique<OdriveHost>(id); }

constexpr MotorBusKind kKind{
    .id = "odrive",
    .title = "ODrive CANSimple, one node per motor",
    .carrier = BusCarrier::kCan,
    .bit_rate = 250'000,  // the device's default
    .data_bit_rate = 0,
    .default_first_id = 0,
    .max_first_id = 0x3E - kWheels,  // 63 is "not addressed"
    .default_watchdog_s = 0.0,
    .host = host,
    .make = make,
};

}  // namespace

const MotorBusKind& motor_bus_odrive() { return kKind; }

}  // namespace omnihil
