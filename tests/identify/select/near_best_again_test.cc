// A round once more beside a better parent: only what came near the best is fitted again.
#include <gtest/gtest.h>

#include <algorithm>

#include "identify/select/selection_iteration.h"
#include "sim/law/effect_registry.h"
#include "tests/identify/select/prepared_selection.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

constexpr const char* kConstant = "motor.torque_constant_Nm_per_A";

// A limit of the current that peaks alone reach: no other effect comes near it.
Bench limited_bench() {
  BenchRecipe recipe;
  recipe.with = {"current_limit.inverse_current_per_A=0.06"};
  recipe.excitations = {Excitation::kSteps, Excitation::kSteps};
  recipe.duration_s = 1.5;
  return simulated_bench(recipe);
}
double limit_of(const CandidateEffect& c) {
  return *value_at(c.fitted.fit.model, "current_limit.inverse_current_per_A");
}

TEST(NearBestAgain, TheBestIsFittedFromItsOwnValuesAndOthersKeepWhatWasSaidOfThem) {
  const Bench bench = limited_bench();
  const PreparedSelection first(bench.dataset, bench.nominal, {.seed = 1, .jobs = 1});
  const Fitted& parent = first.context.base();
  const Iteration before = selection_iteration(first.task, parent);
  ASSERT_EQ(before.chosen, 0);
  const std::optional<Iteration> again = near_best_again(first.task, parent, before);
  ASSERT_TRUE(again);
  ASSERT_EQ(again->chosen, 0);
  const CandidateEffect &was = before.candidates.front(), &is = again->candidates.front();
  EXPECT_EQ(is.screened.name, "current_limit");
  EXPECT_TRUE(is.acceptance.accepted()) << is.acceptance.why;
  EXPECT_NEAR(limit_of(is), limit_of(was), 0.002 * limit_of(was));
  EXPECT_LE(is.fitted.fit.data_cost, 1.001 * was.fitted.fit.data_cost);
  EXPECT_LT(again->candidates.size(), before.candidates.size());
  ASSERT_EQ(again->ranking.size(), before.ranking.size());  // each row once
  for (const RankedEffect& r : before.ranking) {
    const auto row = std::ranges::find(again->ranking, r.effect, &RankedEffect::effect);
    ASSERT_NE(row, again->ranking.end()) << r.effect;
    const bool fitted_again = std::ranges::any_of(
        again->candidates, [&](const CandidateEffect& c) { return c.screened.name == r.effect; });
    EXPECT_TRUE(fitted_again || row->why.ends_with(r.why)) << r.effect << ": " << row->why;
    EXPECT_TRUE(fitted_again || row->accepted_by == AcceptedBy::kNone) << r.effect;
  }
}

TEST(NearBestAgain, TheGainIsThatOverTheBetterParent) {
  const Bench bench = limited_bench();
  PreparedSelection first(bench.dataset, bench.nominal, {.seed = 1, .jobs = 1});
  first.task.applicable = {find_effect("current_limit"), find_effect("coulomb_friction")};
  const Fitted& better = first.context.base();
  FitResult off = better.fit;
  ASSERT_EQ(set_value(off.model, kConstant, 1.02 * *value_at(off.model, kConstant)), "");
  const Fitted worse = fitted(first.context.splits(), first.context.unweighted(), off, 1);
  const Iteration before = selection_iteration(first.task, worse);
  ASSERT_EQ(before.chosen, 0);
  const std::optional<Iteration> again = near_best_again(first.task, better, before);
  ASSERT_TRUE(again);
  ASSERT_EQ(again->chosen, 0);
  EXPECT_GT(again->candidates.front().acceptance.fit.ratio,
            1.02 * before.candidates.front().acceptance.fit.ratio);
}

}  // namespace
}  // namespace omnihil
