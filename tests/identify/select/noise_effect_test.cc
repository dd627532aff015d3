// An effect that is noise: found by where a record is loud, on both rigs; and not where it is not.
#include "identify/select/noise_effect.h"

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

TEST(NoiseEffect, AWrongLawIsNoNoise) {
  const Bench bench = with({"cogging.amplitude_Nm=0.005"});
  EXPECT_FALSE(found_in(bench.dataset, bench.nominal));
  EXPECT_FALSE(found_in(robot_record({{"cogging.amplitude_Nm", 0.005}}, 8.0), robot_candidate()));
}

}  // namespace
}  // namespace omnihil::test
