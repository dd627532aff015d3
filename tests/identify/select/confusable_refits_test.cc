// Which of the effects that are easily confused with the best one are fitted beside it.
#include <gtest/gtest.h>

#include "identify/select/plausibility.h"
#include "identify/select/selection.h"
#include "sim/law/effect_registry.h"
#include "tests/identify/select/prepared_selection.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

// A limit of the current that peaks alone reach: limits of the duty, of a hot winding and a supply that sags are listed as
// confusable with it, and gain nothing here.
TEST(ConfusableRefits, WhatTheNullRefusesWhateverItGainsIsNotFitted) {
  BenchRecipe recipe;
  recipe.with = {"current_limit.inverse_current_per_A=0.06"};
  recipe.excitations = {Excitation::kSteps, Excitation::kSteps};
  recipe.duration_s = 1.5;
  const Bench bench = simulated_bench(recipe);
  const PreparedSelection first(bench.dataset, bench.nominal, {.seed = 1, .jobs = 1});
  ASSERT_FALSE(is_implausible(first.context.base().fit));  // else a prior might be restored
  const Iteration iteration = selection_iteration(first.task, first.context.base());
  ASSERT_GE(iteration.chosen, 0);
  const EffectInfo& best = *iteration.candidates.front().screened.entry->info;
  ASSERT_EQ(best.id, "current_limit");
  int passed_over = 0;
  for (const RankedEffect& r : iteration.ranking) {
    if (r.effect == best.id || !listed_as_confounded(best, *find_effect(r.effect)->info)) continue;
    EXPECT_FALSE(r.refitted && r.signal_to_null < 2.0) << r.effect << ": " << r.signal_to_null;
    passed_over += r.refitted ? 0 : 1;
  }
  EXPECT_GT(passed_over, 0);
}

}  // namespace
}  // namespace omnihil
