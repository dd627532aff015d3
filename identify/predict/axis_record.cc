#include "identify/predict/axis_record.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/predict/axis_setup.h"
#include "identify/predict/interpolation.h"
#include "identify/record/statistics.h"
#include "sim/bench/axis_signal.h"

namespace omnihil {
double AxisRecord::longest_gap_s() const {
  constexpr double kGapPeriods = 10.0;  // a lost row or a late one is bridged, a pause is not; a choice
  return kGapPeriods * period_s;
}

std::vector<double> AxisRecord::position_or_counts() const {
  if (!position.empty()) return position;
  std::vector<double> out = counts;
  for (double& v : out) v /= counts_per_output_rad;
  return out;
}

std::vector<double> AxisRecord::angle() const {
  constexpr double kLeastCountsPerRotorTurn = 200.0;  // four per period of an order of 48 (cogging); derived
  const double per_rotor_turn = counts_per_output_rad * 2.0 * std::numbers::pi / gear_ratio;
  const bool coarse = position.empty() && per_rotor_turn < kLeastCountsPerRotorTurn;
  return coarse ? std::vector<double>() : position_or_counts();
}

// theta_k = sum (t_i - t_{i-1}) (v_i + v_{i-1}) / 2; white noise of the speed makes it wander off by
// sigma sqrt(dt T) in the time T, where a model's own angle is off by its speed's error times T.
std::vector<double> AxisRecord::angle_by_speed() const {
  // 1-sigma of the rotor's angle at the end of the record: an order of 10 is then off by 1 rad. A choice.
  constexpr double kMostWander_rad = 0.1;  // a choice
  if (velocity.empty() || size() < 2 || !angle().empty()) return {};
  const double wander =
      velocity_sigma_rad_s * std::sqrt(period_s * (time_s.back() - time_s.front())) * gear_ratio;
  if (!(wander < kMostWander_rad) || !std::isfinite(velocity[0])) return {};
  return integrated(time_s, velocity, longest_gap_s());
}

double AxisRecord::speed_near(std::size_t k) const {
  // Median of that many measured speeds: two glitches are rejected.
  constexpr std::size_t kSamples = 5;    // a choice
  constexpr double kSlopeSpan_s = 0.01;  // of positions: below a drive's mechanical time constant; a choice
  // The encoder is preferred to a speed that a drive reports, which may be delayed.
  const std::vector<double>& displacement = counts.empty() ? position : counts;
  const double per_rad = counts.empty() ? 1.0 : counts_per_output_rad;
  std::vector<double> near;
  for (std::size_t i = k; i < size() && i < k + kSamples && !velocity.empty(); ++i) {
    if (std::isfinite(velocity[i])) near.push_back(velocity[i]);
  }
  constexpr std::size_t kRests = 20;  // samples without a count; a choice
  const bool at_rest_by_counts = !counts.empty() && k + kRests < size() && counts[k] == counts[k + kRests];
  if (at_rest_by_counts) return 0.0;
  const auto slope = [&] {
    constexpr std::size_t kFewest = 8;  // twice what a parabola's error needs; a choice
    std::size_t end = k;
    while (end < size() && (end < k + kFewest || time_s[end] - time_s[k] < kSlopeSpan_s)) ++end;
    return first_slope(time_s, displacement, k, end) / per_rad;
  };
  // Standard error of a slope through n counted positions: about count / (span sqrt(n)), often far below the
  // noise of one measured speed.
  const double slope_sigma = 1.0 / per_rad / kSlopeSpan_s / std::sqrt(std::max(1.0, kSlopeSpan_s / period_s));
  constexpr double kBetter = 5.0;  // so that a rough error estimate does not decide; a choice
  if (!counts.empty() && velocity_sigma_rad_s > kBetter * slope_sigma) {
    if (const double by_counts = slope(); std::isfinite(by_counts)) return by_counts;
  }
  if (!near.empty() && std::isfinite(velocity[k])) {
    // Where the speed changes within these samples, their median is the speed of a later instant (DECISIONS
    // 37).
    constexpr double kMoves = 6.0;  // sigmas of one reading: 4.2 of the difference of two, p = 2e-5: a choice
    if (std::abs(near.back() - near.front()) > kMoves * velocity_sigma_rad_s) return near.front();
    return median_in_place(near);
  }
  return displacement.empty() ? kMissing : slope();
}

AxisRecord make_axis_record(const Dataset& dataset, const Candidate& nominal, const Run& run) {
  constexpr std::size_t kHalfBusWindow[] = {kBusWindow / 2};  // to either side: derived
  AxisRecord r;
  r.gear_ratio = drive_of(nominal).gear_ratio;
  const std::vector<double>* command = run.signal(command_name(axis_command_kind(dataset)));
  if (command == nullptr) return r;
  const auto first =
      std::find_if(command->begin(), command->end(), [](double v) { return std::isfinite(v); });
  if (first == command->end()) return r;
  const auto first_row = static_cast<std::size_t>(first - command->begin());
  r.time_s = from_row(&run.time_s, first_row);
  r.period_s = median_period_s(r.time_s);
  r.command = held(command, first_row);
  r.enable = held(run.signal("enable"), first_row);
  r.bus = read_bus(dataset, run, first_row, {.half = kHalfBusWindow});
  r.load_torque_Nm = held(run.signal("load_torque"), first_row);
  r.velocity = from_row(run.signal("velocity"), first_row);
  r.velocity_sigma_rad_s = noise_sigma_of(dataset, "velocity", r.velocity);
  r.position = from_row(run.signal("position"), first_row);
  r.counts = from_row(run.signal("encoder"), first_row);
  r.current = from_row(run.signal("motor_current"), first_row);
  r.temperature = from_row(run.signal("winding_temperature"), first_row);
  if (const Channel* encoder = dataset.channel("encoder");
      encoder != nullptr && encoder->counts_per_rev > 0.0) {
    const double per_shaft_rad = encoder->counts_per_rev / (2.0 * std::numbers::pi);
    r.counts_per_output_rad = encoder->on_output ? per_shaft_rad : per_shaft_rad * r.gear_ratio;
  } else {
    r.counts.clear();
  }
  return r;
}

}  // namespace omnihil
