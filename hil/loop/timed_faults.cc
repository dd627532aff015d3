#include "hil/loop/timed_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

bool in_force(const TimedFault& fault, int key, std::int64_t now_ns) {
  return fault.key == key && fault.from_ns <= now_ns && now_ns < fault.until_ns;
}

// Beyond them a number is of a wrong unit; as in scenarios.
constexpr double kForce_N = 1000.0, kHottest_K = 300.0;

bool sound(const RobotFaults& f) {
  bool good = std::abs(f.force_forward_N) <= kForce_N && std::abs(f.force_left_N) <= kForce_N &&
              std::abs(f.moment_Nm) <= kForce_N && f.supply_ratio >= 0.0 && f.supply_ratio <= 2.0;
  for (const double rise_K : f.winding_rise_K) good = good && std::abs(rise_K) <= kHottest_K;
  return good;
}

}  // namespace

void join_faults(RobotFaults& all, const RobotFaults& one) {
  all.force_forward_N += one.force_forward_N;
  all.force_left_N += one.force_left_N;
  all.moment_Nm += one.moment_Nm;
  all.supply_ratio *= one.supply_ratio;
  for (std::size_t w = 0; w < kWheels; ++w) {
    if (one.winding_rise_K[w] != 0.0) all.winding_rise_K[w] = one.winding_rise_K[w];
    all.lifted[w] = all.lifted[w] || one.lifted[w];
    all.blocked[w] = all.blocked[w] || one.blocked[w];
    all.encoder_stuck[w] = all.encoder_stuck[w] || one.encoder_stuck[w];
    all.phase_lost[w] = all.phase_lost[w] || one.phase_lost[w];
  }
}

RobotFaults faults_at(std::span<const TimedFault> plan, int key, std::int64_t now_ns) {
  RobotFaults all;
  for (const TimedFault& fault : plan)
    if (in_force(fault, key, now_ns)) join_faults(all, fault.faults);
  return all;
}

bool silent_at(std::span<const TimedFault> plan, int key, std::int64_t now_ns) {
  return std::ranges::any_of(plan, [&](const TimedFault& f) { return f.silent && in_force(f, key, now_ns); });
}

bool any_silence(std::span<const TimedFault> plan) {
  return std::ranges::any_of(plan, [](const TimedFault& f) { return f.silent; });
}

std::vector<std::string> fault_problems(std::span<const TimedFault> plan, std::span<const int> keys) {
  std::vector<std::string> problems;
  for (const TimedFault& f : plan) {
    if (std::ranges::find(keys, f.key) == keys.end())
      problems.push_back(fmt::format("fault: robot {} is not on the floor", f.key));
    if (f.from_ns < 0 || f.until_ns <= f.from_ns)
      problems.push_back(fmt::format("fault: from {} to {} ns, allowed: from 0 on, to a later instant",
                                     f.from_ns, f.until_ns));
    if (!sound(f.faults)) problems.push_back("fault: a number that no robot meets");
  }
  return problems;
}

}  // namespace omnihil
