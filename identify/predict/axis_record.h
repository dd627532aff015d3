// The columns of one run of an axis as the simulation needs them: no missing drive input, motion at the
// output shaft. n samples each; s, rad (m), rad/s (m/s), A, V, N m (N), degC, counts.
//
//   AxisRecord r = make_axis_record(dataset, nominal, run);
//   r.command[k];        // held from r.time_s[k] on
//
// A missing drive input, bus voltage or enable holds its last value; rows before the first drive input are
// left out. Motion keeps its missing samples as NaN.
#pragma once
#include <cstddef>
#include <vector>

#include "identify/predict/channel.h"
#include "identify/record/dataset.h"

namespace omnihil {

// Window of the local mean by which a measured bus voltage is smoothed, in samples: 21 ms at 1 kHz, longer
// than a PWM or sensor ripple, shorter than the bus sags under a step of the load. A choice; sensitivity not
// measured.
inline constexpr std::size_t kBusWindow = 21;  // a choice

struct AxisRecord {
  double period_s = 0.0;  // median
  std::vector<double> time_s;
  std::vector<double> command;
  std::vector<double> enable, load_torque_Nm;  // empty: not measured
  BusReading bus;
  // measured, NaN where missing; empty: not measured
  std::vector<double> velocity, position, counts, current, temperature;
  double counts_per_output_rad = 0.0;
  double velocity_sigma_rad_s = 0.0;  // stated, or estimated from differences
  double gear_ratio = 1.0;            // nominal

  std::size_t size() const { return time_s.size(); }
  double longest_gap_s() const;  // that is bridged
  bool gap_before(std::size_t k) const { return k > 0 && time_s[k] - time_s[k - 1] > longest_gap_s(); }
  // Position of the output from its sensor, else from its encoder; empty: not measured.
  std::vector<double> position_or_counts() const;
  // The same; empty as well where it is too coarse for laws of the angle (fewer than 200 counts per rotor turn).
  std::vector<double> angle() const;
  // Where no angle is measured: angle of the output since the first sample, by integrating the measured
  // speed. NaN from the first gap on; empty where the speed is not measured, or its integrated noise exceeds
  // 0.1 rad of the rotor (DECISIONS 44).
  std::vector<double> angle_by_speed() const;
  // Speed of the output at sample k: measured, else from the positions around it; NaN where neither is known.
  double speed_near(std::size_t k) const;
};

AxisRecord make_axis_record(const Dataset& dataset, const Candidate& nominal, const Run& run);

}  // namespace omnihil
