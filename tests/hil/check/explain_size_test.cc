// The error given with a size is the size's error: over many robots that are worn by slightly different amounts, with noise
// and seeds of their own, 95 % of the intervals hold the truth.
#include "hil/check/explain_size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/binomial_bounds.h"
#include "tests/hil/check/driven_robots.h"

namespace omnihil {
namespace {

constexpr int kRobots = 20;  // of each cause
constexpr double kTail = 1e-3;

// How many intervals hold what was planted: about `planted`, another amount in each, since a loop with counted encoders
// makes another sequence of roundings of each.
int covered(const std::string& name, double planted) {
  const std::vector<ExplainCandidate> all = explain_candidates(driven::robot().model);
  const ExplainCandidate& c = *std::ranges::find(all, name, &ExplainCandidate::name);
  int count = 0;
  for (int n = 1; n <= kRobots; ++n) {
    const auto seed = static_cast<std::uint64_t>(n);
    const double truth = planted * (1.0 + 0.01 * std::sin(37.0 * n));
    SessionSetup worn = driven::robot();
    worn.model = *c.model(truth);
    worn.plant.seed = 1000 + seed;
    Recording recording = driven::drive(worn, 4000);
    driven::add_noise(recording, seed);
    ReplayOptions options;
    options.model = driven::robot().model;
    options.seed = 5000 + 100 * seed;
    ExplainSearch search(recording, driven::rem(), options);
    const Trajectories base = search.run(*options.model);
    search.weigh_by(base);
    const Weighted j =
        search.sensitivity(search.run(*c.model(c.to)), search.run(*c.model(c.from)), c.to - c.from);
    const auto by = explained_by(search, c, j, search.residual(base));
    EXPECT_TRUE(by && std::isfinite(by->sigma)) << name << " " << truth;
    if (!by) continue;
    // As narrow as what a user needs to tell 5 % from 4.
    EXPECT_LT(kExplainT * by->sigma, 0.1 * std::abs(planted)) << name;
    if (std::abs(by->is - truth) <= kExplainT * by->sigma) ++count;
  }
  return count;
}

TEST(SlowExplainSize, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const double torque = [] {
    for (const ExplainCandidate& c : explain_candidates(driven::robot().model))
      if (c.name == "motor.torque_constant_Nm_per_A") return 1.05 * c.value;
    return 0.0;
  }();
  const int by_torque = covered("motor.torque_constant_Nm_per_A", torque);
  const int by_supply = covered("battery_sag.resistance_ohm", 0.15);
  std::printf("%d and %d of %d intervals hold the truth\n", by_torque, by_supply, kRobots);
  const auto [low, high] = binomial_bounds(2 * kRobots, 0.95, kTail);
  EXPECT_GE(static_cast<std::uint64_t>(by_torque + by_supply), low);
  EXPECT_LE(static_cast<std::uint64_t>(by_torque + by_supply), high);
}

}  // namespace
}  // namespace omnihil
