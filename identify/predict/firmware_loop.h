// A robot's own firmware in the loop of a simulated robot: what it is told, when it runs, what it asks of the bridges.
//
//   FirmwareLoop loop(source, latency_s, record.time_s[0]);
//   loop.hear(now_s, std::array{0.5, 0.0, 1.0}, CommandFrame::kBodyVelocity);      // m/s, m/s, rad/s: acts latency_s later
//   if (loop.due(now_s)) loop.tick(now_s, sees);
//   loop.duty(), loop.enabled();                                         // until loop.next_s()
//
// Each loop has a firmware that was just switched on, at the record's first row: a record should begin at rest. Commands arrive
// between its ticks as radio packets do, the newest that is due. Its encoders count down-rounded, its current is the mean
// since the tick before; it is shown no ball, and encoder faults that a model has are not shown to it.
#pragma once
#include <array>
#include <deque>
#include <memory>
#include <span>

#include "identify/predict/firmware_source.h"
#include "sim/robot/radio_controller.h"
#include "sim/robot/robot_history.h"

namespace omnihil {

// As its radio says it. Of a body three numbers, of wheels four.
RobotCommand radio_command(std::span<const double> value, CommandFrame frame);

class FirmwareLoop {
 public:
  FirmwareLoop(const FirmwareSource& source, double latency_s, double start_s, double report_filter_s = 0.0);

  void hear(double now_s, std::span<const double> value, CommandFrame frame);
  bool due(double now_s) const { return now_s >= next_s_ - kSame_s; }
  double next_s() const { return next_s_; }  // of the next tick
  // Of what its sensors see: rotor angles, charges (since whenever), bus voltage, turn rate, acceleration. The rotors' speeds
  // are for firmware whose sensors are emulated.
  void tick(double now_s, const RobotInstant& sees);

  double period_s() const { return period_s_; }
  const std::array<double, kWheels>& duty() const { return duty_; }
  const std::array<bool, kWheels>& enabled() const { return enabled_; }
  // As its telemetry tells them, at the rotors; of one that tells none the shafts' own, low-passed as by report_filter_s.
  // False: neither.
  bool tells(double gear_ratio, std::array<double, kWheels>& omega_rotor_rad_s) const;
  // It no longer answers.
  bool failed() const { return !firmware_->failure().empty(); }

 private:
  static constexpr double kSame_s = 1e-9;  // rounding of sums of periods; a choice
  struct Packet {
    double due_s;
    RobotCommand command;
  };
  std::int64_t clock_ns(double now_s) const;

  std::unique_ptr<Firmware> firmware_;
  double counts_per_rad_, latency_s_, start_s_, report_filter_s_, next_s_, period_s_;
  std::deque<Packet> packets_;
  std::array<double, kWheels> last_charge_C_{}, duty_{}, filtered_rad_s_{};
  std::array<bool, kWheels> enabled_{};
  double last_s_;
  std::int64_t ticks_ = 0;
};

}  // namespace omnihil
