// The host's end of a motor bus for one axis: what asks a motor controller for a voltage or a torque, and what
// it answers. Made by the file of its bus (buses/) from the ids, registers and scales of the simulated device.
//
//   std::unique_ptr<AxisHost> host = kind->host(1);
//   host->ask(AxisDemand::kVoltage, 3.0, frames);       // armed where it is not; its state is asked for, too
//   host->stop(frames);                                 // the bridge lets go, before anything else is said
//   if (host->hear(frame)) host->state().turns;         // a whole sample has come since it was last asked
//
// Values as the device tells them, turns of the bus's shaft; NaN: not told. Cannot: set a device up, clear its
// errors (its owner has to look at why they are there), calibrate it.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "firmware_iface/motor_bus/bus_frame.h"

namespace omnihil {

enum class AxisDemand : std::uint8_t { kVoltage, kTorque };

struct AxisState {
  static constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();
  double turns = kNotTold, turns_s = kNotTold, torque_Nm = kNotTold, q_current_A = kNotTold, bus_V = kNotTold;
  std::string trouble;  // why it does not do what it is asked; empty: it does
};

class AxisHost {
 public:
  virtual ~AxisHost() = default;
  virtual bool can(AxisDemand demand) const = 0;
  virtual void ask(AxisDemand demand, double value, std::vector<BusFrame>& out) = 0;
  virtual void stop(std::vector<BusFrame>& out) = 0;
  virtual bool hear(const BusFrame& frame) = 0;
  // Each question has an answer of its own, in order; false: a new question ends the one before.
  virtual bool answers_each() const = 0;
  const AxisState& state() const { return state_; }

 protected:
  AxisState state_;
};

}  // namespace omnihil
