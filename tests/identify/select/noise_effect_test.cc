// An effect that is noise: found by where a record is loud, on both rigs; and not where it is not.
#include "identify/select/noise_effect.h"

#include <cmath>
#include <utility>

#include "identify/select/selection_context.h"
#include "tests/identify/simulated_bench.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {
namespace {

constexpr double kJitter_s = 100e-6;

// What the search finds in a dataset whose model is the world's, but for what is hidden.
std::optional<NoiseEffect> found_in(const Dataset& dataset, const Candidate& nominal) {
  const SelectionContext bench(dataset, nominal, {.seed = 1, .jobs = 2});
  std::vector<const EffectEntry*> applicable;
  for (const EffectEntry* e : all_effects()) {
    if (bench.predictor().applies(*e).empty()) applicable.push_back(e);
  }
  return noise_effect(
      {.predictor = &bench.predictor(), .unweighted = &bench.unweighted(), .model = &nominal, .seed = 1},
      applicable);
}

Bench with(const std::vector<std::string>& hidden) {
  BenchRecipe recipe;
  recipe.with = hidden;
  return simulated_bench(recipe);
}

TEST(NoiseEffect, JitterOfADriveIsFoundWithItsSize) {
  const Bench bench = with({"sample_jitter.sigma_s=1e-4"});
  const auto found = found_in(bench.dataset, bench.nominal);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->use.entry->info->id, "sample_jitter");
  EXPECT_NEAR(found->strength.value, kJitter_s, 0.1 * kJitter_s);
}

TEST(NoiseEffect, JitterOfARobotIsFoundWithItsSize) {
  const auto found = found_in(robot_record({{"sample_jitter.sigma_s", kJitter_s}}, 8.0), robot_candidate());
  ASSERT_TRUE(found);
  EXPECT_EQ(found->use.entry->info->id, "sample_jitter");
  EXPECT_NEAR(found->strength.value, kJitter_s, 0.1 * kJitter_s);
}

TEST(NoiseEffect, NothingIsFoundWhereNothingIsHidden) {
  const Bench bench = with({});
  EXPECT_FALSE(found_in(bench.dataset, bench.nominal));
  EXPECT_FALSE(found_in(robot_record({}, 8.0), robot_candidate()));
}

std::vector<double> every_fourth(const std::vector<double>& x) {
  std::vector<double> out;
  for (std::size_t k = 0; k < x.size(); k += 4) out.push_back(x[k]);
  return out;
}

// Counts that lag by 1 % of the way, whichever way it goes: as large as the speed, as missed counts are, and no noise.
TEST(NoiseEffect, AnErrorThatGrowsWithTheSpeedIsNoNoise) {
  BenchRecipe recipe;
  recipe.excitations.assign(3, Excitation::kChirp);
  Bench bench = simulated_bench(recipe);
  for (omnihil::Run& run : bench.dataset.runs) {
    std::vector<double>& counts = run.signals["encoder"];
    double way = 0.0, before = counts.front();
    for (double& c : counts) {
      way += std::abs(c - std::exchange(before, c));
      c = std::floor(c - 0.01 * way);
    }
    run.time_s = every_fourth(run.time_s);
    for (auto& [name, values] : run.signals) values = every_fourth(values);
  }
  EXPECT_FALSE(found_in(bench.dataset, bench.nominal));
}

TEST(NoiseEffect, AWrongLawIsNoNoise) {
  const Bench bench = with({"cogging.amplitude_Nm=0.005"});
  EXPECT_FALSE(found_in(bench.dataset, bench.nominal));
  EXPECT_FALSE(found_in(robot_record({{"cogging.amplitude_Nm", 0.005}}, 8.0), robot_candidate()));
}

}  // namespace
}  // namespace omnihil::test
