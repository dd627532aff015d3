// Which of several laws is the answer where one becomes another, and where one hides another.
#include <gtest/gtest.h>

#include <algorithm>

#include "identify/select/effect_variants.h"
#include "identify/select/elimination.h"
#include "identify/select/idle_effect.h"
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

// Grease's drag, fitted to a map.
struct Greased : PreparedSelection {
  explicit Greased(const TorqueMap& map)
      : PreparedSelection(map.dataset, map.nominal, {.seed = 1, .jobs = 1}) {
    const Candidate& base = context.base().fit.model;
    const EffectUse grease = at_typical_size(neutral_use(*find_effect("grease_drag")), base);
    fitted = refit_as_it_is(setup, with_use(base, grease), 1);
    EXPECT_TRUE(fitted.finite);
  }

  RefitSetup setup = context.setup(true, [] { return false; });
  Fitted fitted;
};

// The law that could stand in its place.
std::optional<NestedLaw> law_within_grease(const TorqueMap& map) {
  const Greased bench(map);
  return nested_law(bench.task, bench.setup, bench.fitted, "grease_drag");
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

// Coulomb friction and the air's drag, two numbers, in place of grease, which has two.
TEST(NestedLaws, ARichLawThatImitatesTwoGivesWayToBoth) {
  const TorqueMap map({.coulomb_Nm = 0.003, .drag_Nm_s2_per_rad2 = 2e-8});
  const Greased bench(map);
  const std::optional<SplitLaw> split =
      split_law(bench.task, bench.setup, bench.fitted, "grease_drag", "quadratic_drag");
  ASSERT_TRUE(split.has_value());
  EXPECT_EQ(split->simpler, "coulomb_friction");
  ASSERT_GE(split->iteration.chosen, 0);
  EXPECT_EQ(split->iteration.candidates[static_cast<std::size_t>(split->iteration.chosen)].screened.name,
            "quadratic_drag");
  const auto found = [&](const char* path) { return value_at(split->fitted.fit.model, path).value_or(0.0); };
  EXPECT_NEAR(found("coulomb_friction.torque_Nm"), 0.003, 1e-4);
  EXPECT_NEAR(found("quadratic_drag.coefficient_Nm_s2_per_rad2"), 2e-8, 1e-9);
}

TEST(NestedLaws, ARichLawThatIsMeantIsNotSplit) {
  for (const TorqueMapRecipe& recipe :
       {TorqueMapRecipe{.grease_Nm = 0.003}, TorqueMapRecipe{.coulomb_Nm = 0.003}}) {
    const TorqueMap map(recipe);
    const Greased bench(map);
    EXPECT_FALSE(
        split_law(bench.task, bench.setup, bench.fitted, "grease_drag", "quadratic_drag").has_value());
  }
}

// An effect beside a nominal model, with a viscous friction that is said to have gone to its bound on the way.
std::optional<AcceptanceResult> with_friction_held(TorqueMap map, const char* effect) {
  map.nominal = axis_with_friction("{ value = 1.3e-5, tolerance = 3 }");
  PreparedSelection bench(map.dataset, map.nominal, {.seed = 1, .jobs = 1});
  const RefitSetup setup = bench.context.setup(true, [] { return false; });
  const auto friction_of = [](FitResult& fit) -> ParameterEstimate& {
    return *std::ranges::find(fit.parameters, kFriction, &ParameterEstimate::path);
  };
  FitResult as_believed = bench.context.base().fit;
  as_believed.model = map.nominal;
  friction_of(as_believed).prior_deviation_sigmas = 0.5;
  friction_of(as_believed).at_bound = false;
  const Fitted parent = fitted(*bench.task.splits, *bench.task.unweighted, as_believed, 1);
  bench.task.acceptance_context.base_fit = &parent.fit;
  const EffectUse use = at_typical_size(neutral_use(*find_effect(effect)), map.nominal);
  Fitted child = refit_as_it_is(setup, with_use(map.nominal, use), 1);
  friction_of(child.fit).prior_deviation_sigmas = -3.3;
  friction_of(child.fit).at_bound = true;
  const AcceptanceResult refused =
      test_acceptance(bench.task.acceptance_context, parent, child, effect, kScreenedBefore);
  EXPECT_TRUE(refused.why.starts_with("it moves motor.viscous_friction_Nm_s_per_rad to its bound"))
      << refused.why;
  return accepted_at_belief(bench.task, setup, parent, child, refused, effect, kScreenedBefore);
}

TEST(HeldNumbers, AGainThatDoesNotNeedThemCounts) {
  const auto drag = with_friction_held(TorqueMap({.drag_Nm_s2_per_rad2 = 2e-8}), "quadratic_drag");
  ASSERT_TRUE(drag.has_value());
  EXPECT_TRUE(drag->accepted());
}

// Viscous friction, of which dry friction explains three quarters: (1/2)^2 / (1/3).
TEST(HeldNumbers, AGainThatNeedsThemDoesNot) {
  EXPECT_FALSE(
      with_friction_held(TorqueMap({.friction_Nm_s_per_rad = 1.3e-4}), "coulomb_friction").has_value());
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
