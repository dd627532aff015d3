// An addition whose gain comes from what stands beside it.
#include "identify/select/idle_effect.h"

#include <gtest/gtest.h>

#include "identify/select/effect_variants.h"
#include "sim/law/effect_registry.h"
#include "sim/model/effect_reader.h"
#include "tests/identify/fake_residuals.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

TEST(GainNotItsOwn, IsThatOfAnEffectWhichMayBeIdle) {
  const ZeroRuns runs({Split::kTraining}, 1000);
  const Eigen::VectorXd with = Eigen::VectorXd::Ones(1000);
  EXPECT_NE(gain_not_its_own(runs.training, with, with), "");
  EXPECT_NE(gain_not_its_own(runs.training, with, 1.005 * with), "");  // 1 % of the energy
  EXPECT_EQ(gain_not_its_own(runs.training, with, 1.01 * with), "");   // 2 %
  EXPECT_EQ(gain_not_its_own(runs.training, with, Eigen::VectorXd()), "");
}

// Not neutral: a neutral law is left out, and what is simulated beside it takes longer steps.
TEST(GainNotItsOwn, AnIdleEffectHasAMillionthOfItsStrengthAndItsShapes) {
  BenchRecipe recipe;
  recipe.duration_s = 0.5;
  const Bench bench = simulated_bench(recipe);
  const Candidate model = with_use(bench.nominal, typical_use(*find_effect("cogging"), nullptr));
  const Candidate idle = with_idle_effect(model, "cogging");
  for (const EffectUse& use : idle.effects) {
    const EffectUse* was = use_of(model, use.entry->info->id);
    ASSERT_NE(was, nullptr);
    EXPECT_FALSE(is_neutral(use)) << use.entry->info->id;
    for (std::size_t i = 0; i < use.values.size(); ++i) {
      const EffectParam& row = use.entry->info->params[i];
      const bool scaled = use.entry->info->id == "cogging" && row.role != ParamRole::kShape;
      const double asked = scaled ? row.neutral + 1e-6 * (was->values[i] - row.neutral) : was->values[i];
      EXPECT_DOUBLE_EQ(use.values[i], asked) << row.name;
    }
  }
}

// Next to no play is the compliance of its contact, next to no dead band a bridge that coasts at zero duty: they are taken out.
TEST(GainNotItsOwn, AnIdlePlayOrDeadBandIsNone) {
  BenchRecipe recipe;
  recipe.duration_s = 0.5;
  const Bench bench = simulated_bench(recipe);
  for (const char* name : {"backlash", "pwm_dead_band"}) {
    const Candidate model = with_use(bench.nominal, typical_use(*find_effect(name), nullptr));
    EXPECT_EQ(use_of(with_idle_effect(model, name), name), nullptr) << name;
  }
}

}  // namespace
}  // namespace omnihil
