#include "hil/check/law_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware_iface/omnihil_firmware.h"
#include "hil/recording/recorded_samples.h"
#include "sim/robot/plant.h"

namespace omnihil {
namespace {

constexpr std::size_t kLeastRows =
    20;  // a rule of thumb of regression, per coefficient (Harrell 2015, ch. 4)
constexpr double kLeastRSquared = 0.8;  // a choice: of the difference, so that one change explains nearly all
constexpr double kLeastLead = 0.05;     // of R^2 over the second term: below it, two terms say the same
constexpr double kDutyLimit = 0.98;     // a loop at its limit shows no term

struct Term {
  const char* name;
  const char* what;
  const char* unit;
};
enum TermIndex : std::size_t { kOutput, kError, kIntegral, kTarget, kSlope, kTerms };
constexpr std::array<Term, kTerms> kTermRows{{{"the output", "a gain of the whole loop", "V/V"},
                                              {"the speed error", "a P gain", "V s/rad"},
                                              {"the integral of the speed error", "an I gain", "V/rad"},
                                              {"the target", "a velocity feedforward", "V s/rad"},
                                              {"the slope of the speed", "a D gain", "V s^2/rad"}}};

// Time constants of the loop's own low pass on the counted speed, in ticks. Firmwares filter by powers of two.
constexpr std::array<double, 6> kFilterTicks{0.0, 1.0, 2.0, 4.0, 8.0, 16.0};

// What one tick shows of one wheel.
struct Tick {
  bool linear = false;  // both drive, below their limits
  double dt_s = 0.0, counts = 0.0;
  double output_V = 0.0, difference_V = 0.0;
  double target_rad_s = 0.0, omega_rad_s = 0.0;  // as fed back
};

struct Row {
  double difference_V = 0.0;
  std::array<double, kTerms> term{};
};

struct Places {
  std::size_t duty, mode, bus, target, omega, counts;
  Places(const RecordingHeader& header, int wheel) {
    const auto place = [&](const std::string& name) { return column_place(header, name); };
    const std::string number = "_" + std::to_string(wheel + 1);
    duty = place("duty_ratio" + number);
    mode = place("drive_mode" + number);
    bus = place("bus_voltage_V");
    target = place("feedback_omega_wheel_target_rad_s" + number);
    omega = place("feedback_omega_wheel_rad_s" + number);
    counts = place("encoder_counts" + number);
  }
  bool complete(const RecordingHeader& header) const {
    return std::max({duty, mode, bus, target, omega, counts}) < header.columns.size();
  }
};

bool driven(const RecordedChunk& tick, const Places& at) {
  return tick.sample[at.mode] == double{OMNIHIL_DRIVE_DUTY} && std::abs(tick.sample[at.duty]) < kDutyLimit;
}

std::vector<Tick> ticks_of(const Recording& recorded, const Recording& alone, int robot_id, int wheel) {
  const Places from(recorded.header, wheel), to(alone.header, wheel);
  std::vector<Tick> ticks;
  if (!from.complete(recorded.header) || !to.complete(alone.header)) return ticks;
  const auto a = samples_of(recorded, robot_id), b = samples_of(alone, robot_id);
  for (std::size_t i = 1; i < std::min(a.size(), b.size()); ++i) {
    const std::vector<double>&s = a[i]->sample, &t = b[i]->sample;
    ticks.push_back({driven(*a[i], from) && driven(*b[i], to),
                     static_cast<double>(a[i]->now_ns - a[i - 1]->now_ns) / 1e9,
                     s[from.counts] - a[i - 1]->sample[from.counts], s[from.duty] * s[from.bus],
                     (t[to.duty] - s[from.duty]) * s[from.bus], s[from.target], s[from.omega]});
  }
  return ticks;
}

// Wheel angle per count, from the speed fed back: least squares through the origin; 0 where nothing turned.
double rad_per_count(const std::vector<Tick>& ticks) {
  double counts = 0.0, both = 0.0;
  for (const Tick& tick : ticks) {
    if (!(tick.dt_s > 0.0)) continue;
    const double rate = tick.counts / tick.dt_s;
    counts += rate * rate;
    both += rate * tick.omega_rad_s;
  }
  return counts > 0.0 ? both / counts : 0.0;
}

// The terms with the counted speed behind a low pass of `filter_ticks`: y += (x - y) / (filter_ticks + 1).
std::vector<Row> rows_of(const std::vector<Tick>& ticks, double scale_rad, double filter_ticks) {
  std::vector<Row> rows;
  double omega = 0.0, integral_rad = 0.0;
  for (const Tick& tick : ticks) {
    if (!(tick.dt_s > 0.0)) continue;
    const double before = omega;
    omega += (scale_rad * tick.counts / tick.dt_s - omega) / (filter_ticks + 1.0);
    if (!tick.linear) {
      integral_rad = 0.0;
      continue;
    }
    const double error = tick.target_rad_s - omega;
    integral_rad += error * tick.dt_s;
    rows.push_back({tick.difference_V,
                    {tick.output_V, error, integral_rad, tick.target_rad_s, (omega - before) / tick.dt_s}});
  }
  return rows;
}

}  // namespace

std::string LawDifference::text() const {
  return fmt::format("grows with {}, {:+.4g} {} (R^2 {:.2f}): {}", term, slope, unit, r_squared, what);
}

std::optional<LawDifference> law_difference(const Recording& recorded, const Recording& alone, int robot_id,
                                            int wheel) {
  const std::vector<Tick> ticks = ticks_of(recorded, alone, robot_id, wheel);
  const double scale_rad = rad_per_count(ticks);
  std::array<double, kTerms> slope{}, r_squared{};
  for (const double filter_ticks : kFilterTicks) {
    const std::vector<Row> rows = rows_of(ticks, scale_rad, filter_ticks);
    if (rows.size() < kLeastRows) return std::nullopt;
    double total = 0.0;
    for (const Row& row : rows) total += row.difference_V * row.difference_V;
    if (!(total > 0.0)) return std::nullopt;
    for (std::size_t k = 0; k < kTerms; ++k) {
      double xx = 0.0, xy = 0.0;
      for (const Row& row : rows) xx += row.term[k] * row.term[k], xy += row.term[k] * row.difference_V;
      if (!(xx > 0.0) || xy * xy / (xx * total) <= r_squared[k]) continue;
      slope[k] = xy / xx;
      r_squared[k] = xy * xy / (xx * total);
    }
  }
  const auto best = static_cast<std::size_t>(std::ranges::max_element(r_squared) - r_squared.begin());
  for (std::size_t k = 0; k < kTerms; ++k) {
    if (k != best && r_squared[k] > r_squared[best] - kLeastLead) return std::nullopt;
  }
  if (r_squared[best] < kLeastRSquared) return std::nullopt;
  const Term& term = kTermRows[best];
  return LawDifference{term.name, term.what, term.unit, slope[best], r_squared[best]};
}

std::vector<std::string> law_differences(const Recording& recorded, const Recording& alone) {
  std::vector<std::string> lines;
  for (const int robot : recorded.header.robot_ids) {
    for (int wheel = 0; wheel < static_cast<int>(kWheels); ++wheel) {
      if (const auto law = law_difference(recorded, alone, robot, wheel))
        lines.push_back(
            fmt::format("robot {}, wheel {}: the duty's difference {}", robot, wheel + 1, law->text()));
    }
  }
  return lines;
}

}  // namespace omnihil
