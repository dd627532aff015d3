// What is at the other end of the wire when one axis is driven: a motor controller on its bus, or a board with the shim.
//
//   end.ask(3.0, now_ns);                              // V, N m or duty, as it was opened for
//   end.stop(now_ns);                                  // the bridge lets go; said before anything else
//   end.read(now_ns, samples);                         // what has come
//   if (!end.lost().empty()) …                         // the wire is gone
//
// A sample's value is the drive that is in force from its time on; NaN: the bridge is off. What passes on the wire is kept
// as text until it is taken: frames as candump has them, bytes as `omnihil import` reads them.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace omnihil {

struct AxisMoment {
  static constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();
  std::int64_t now_ns = 0;   // when it came
  double time_s = 0.0;       // when it was: of our clock, or of the device's (AxisEnd::device_clock)
  double uncertain_s = 0.0;  // of time_s, to either side
  double value = kNotTold;
  double position_rad = kNotTold, velocity_rad_s = kNotTold;  // of the output
  double counts = kNotTold;                                   // of the rotor's encoder
  double current_A = kNotTold, bus_V = kNotTold;              // of the model's motor
};

class AxisEnd {
 public:
  virtual ~AxisEnd() = default;
  virtual std::string_view name() const = 0;
  virtual int handle() const = 0;  // readable when something waits; -1: none
  virtual void ask(double value, std::int64_t now_ns) = 0;
  virtual void stop(std::int64_t now_ns) = 0;
  virtual void read(std::int64_t now_ns, std::vector<AxisMoment>& out) = 0;
  virtual std::string trouble() const { return {}; }  // of the device: why it does not do what it is asked
  virtual std::string lost() const = 0;
  virtual bool device_clock() const { return false; }
  virtual double counts_per_turn() const { return 0.0; }  // of `counts`
  std::string take_log() { return std::exchange(log_, {}); }

 protected:
  std::string log_;
};

}  // namespace omnihil
