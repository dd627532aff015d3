// Which of several laws is the answer where one becomes another, and where one hides another.
#include <gtest/gtest.h>

#include <algorithm>

#include "identify/select/effect_variants.h"
#include "identify/select/elimination.h"
#include "identify/select/nested_law.h"
#include "identify/select/selection_pair.h"
#include "sim/law/effect_registry.h"
#include "tests/identify/select/prepared_selection.h"
#include "tests/identify/torque_map.h"

namespace omnihil {
namespace {

// Stribeck, grease and bristles become Coulomb friction at a limit of their shapes and leave as little here.
TEST(NestedLaws, TheSimplestThatExplainsIsTheAnswer) {
  const TorqueMap map({.coulomb_Nm = 0.003});
  const Diagnosis d = diagnose(map.dataset, map.nominal, {.progress = {}, .stop = {}});
  ASSERT_EQ(d.effects, std::vector<std::string>{"coulomb_friction"});
  EXPECT_EQ(d.outcome, Outcome::kFound);
  // standard error of a mean of 200 signs: 1e-4 / sqrt(200) = 7e-6
  EXPECT_NEAR(value_at(d.final_fit.model, "coulomb_friction.torque_Nm").value_or(0.0), 0.003, 3e-5);
}

// Grease's drag, fitted to the map, and the law that could stand in its place.
std::optional<NestedLaw> law_within_grease(const TorqueMap& map) {
  const PreparedSelection bench(map.dataset, map.nominal, {.seed = 1, .jobs = 1});
  const RefitSetup setup = bench.context.setup(true, [] { return false; });
  const Candidate& base = bench.context.base().fit.model;
  const EffectUse grease = at_typical_size(neutral_use(*find_effect("grease_drag")), base);
  const Fitted current = refit_as_it_is(setup, with_use(base, grease), 1);
  EXPECT_TRUE(current.finite);
  return nested_law(bench.task, setup, current, "grease_drag");
}

TEST(NestedLaws, AShapeThatEarnsNothingGivesWay) {
  const std::optional<NestedLaw> simpler = law_within_grease(TorqueMap({.coulomb_Nm = 0.003}));
  ASSERT_TRUE(simpler.has_value());
  EXPECT_EQ(simpler->name, "coulomb_friction");
  EXPECT_NEAR(value_at(simpler->fitted.fit.model, "coulomb_friction.torque_Nm").value_or(0.0), 0.003, 3e-5);
}

TEST(NestedLaws, AShapeThatTheDataShowStays) {
  EXPECT_FALSE(law_within_grease(TorqueMap({.grease_Nm = 0.003})).has_value());
}

// The base fit, one iteration and its refusal: as if each effect alone raised the error of another motion.
struct Refused : PreparedSelection {
  explicit Refused(const TorqueMap& map)
      : PreparedSelection(map.dataset, map.nominal, {.seed = 1, .jobs = 1}) {
    singles = selection_iteration(task, context.base());
    for (CandidateEffect& c : singles.candidates) c.acceptance.accepted_by = AcceptedBy::kNone;
    singles.chosen = -1;
  }

  Iteration singles;
};

TEST(EffectPairs, ASecondEffectIsFoundBesideARefusedOne) {
  const TorqueMap map({.load_Nm = 0.004, .coulomb_Nm = 0.003});
  const Refused refused(map);
  const EffectPair pair = selection_pair(refused.task, refused.context.base(), refused.singles);
  ASSERT_TRUE(pair.found());
  std::vector<std::string> names = pair.names;
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"constant_load", "coulomb_friction"}));
  EXPECT_NEAR(value_at(pair.fitted.fit.model, "coulomb_friction.torque_Nm").value_or(0.0), 0.003, 3e-5);
}

// One effect alone is hidden: nothing is left that a second could take.
TEST(EffectPairs, NoneIsFoundWhereOneEffectIsAllThereIs) {
  const TorqueMap map({.coulomb_Nm = 0.003});
  const Refused refused(map);
  EXPECT_FALSE(selection_pair(refused.task, refused.context.base(), refused.singles).found());
}

// What is refused after its fit converged is in the ranking with that reason, and the next accepted one is chosen.
TEST(RefusedChoice, TheNextAcceptedOneIsChosenAndTheReasonStands) {
  const TorqueMap map({.coulomb_Nm = 0.003});
  Refused bench(map);
  Iteration iteration = selection_iteration(bench.task, bench.context.base());
  ASSERT_GE(iteration.chosen, 0);
  const auto name_of = [](const CandidateEffect& c) { return c.screened.name; };
  const std::string first = name_of(iteration.candidates[static_cast<std::size_t>(iteration.chosen)]);
  refuse_chosen(bench.task, bench.context.base(), "it ends at a bound", iteration);
  ASSERT_GE(iteration.chosen, 0);
  const CandidateEffect& next = iteration.candidates[static_cast<std::size_t>(iteration.chosen)];
  EXPECT_NE(name_of(next), first);
  EXPECT_TRUE(next.acceptance.accepted());
  double draws = 0.0;
  for (const RankedEffect& r : iteration.ranking) {
    draws += r.selection_frequency;
    if (r.effect != first) continue;
    EXPECT_EQ(r.accepted_by, AcceptedBy::kNone);
    EXPECT_EQ(r.why, "it ends at a bound");
  }
  EXPECT_LE(draws, 1.0 + 1e-9);  // shares of the same draws
}

// What is taken, in this order, out of a model with these effects that was fitted to the map.
std::vector<std::string> eliminated(const TorqueMap& map, EffectsFound found) {
  const PreparedSelection bench(map.dataset, map.nominal, {.seed = 1, .jobs = 1});
  const RefitSetup setup = bench.context.setup(true, [] { return false; });
  Candidate with = bench.context.base().fit.model;
  std::vector<std::string> out;
  for (const std::string& name : found.names)
    with = with_use(with, at_typical_size(neutral_use(*find_effect(name)), with));
  Fitted current = refit_as_it_is(setup, with, 1);
  EXPECT_TRUE(current.finite);
  while (auto less = unneeded_effect(bench.task, setup, current, found, !out.empty())) {
    out.push_back(less->name);
    std::erase(found.names, less->name);
    current = std::move(less->fitted);
  }
  return out;
}

using Names = std::vector<std::string>;

// Nothing is hidden. The latest was accepted beside one that is gone: that says nothing of it any more.
TEST(Elimination, TheLatestIsTestedAgainOnceAnotherIsGone) {
  const Names both{"constant_load", "coulomb_friction"};
  EXPECT_EQ(eliminated(TorqueMap({}), {.names = both, .aliased_parameters = {}, .pair = {}}), both);
}

TEST(Elimination, WhatIsThereStays) {
  const Names both{"constant_load", "coulomb_friction"};
  const TorqueMap map({.load_Nm = 0.004, .coulomb_Nm = 0.003});
  EXPECT_EQ(eliminated(map, {.names = both, .aliased_parameters = {}, .pair = {}}), Names{});
  const TorqueMap one({.coulomb_Nm = 0.003});
  EXPECT_EQ(eliminated(one, {.names = both, .aliased_parameters = {}, .pair = both}), Names{"constant_load"});
}

}  // namespace
}  // namespace omnihil
