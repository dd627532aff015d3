// The sub-step follows from an error that is known in closed form.
#include "identify/predict/axis_substep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/law/effect_registry.h"
#include "sim/model/axis_model.h"

namespace omnihil {
namespace {

Candidate nominal() {
  const AxisReading r = read_axis_model(R"(
format = "omnihil-model/1"
rig = "axis"
[motor]
resistance_ohm = 0.5
inductance_H = 0.0003
torque_constant_Nm_per_A = 0.03
rotor_inertia_kg_m2 = 1e-5
viscous_friction_Nm_s_per_rad = 5e-6
[supply]
voltage_V = 24
)",
                                        "model.toml", nullptr);
  for (const ModelProblem& p : r.problems) ADD_FAILURE() << p.text();
  return r.model ? candidate_of(r.model->file, r.model->effects) : Candidate{};
}

AxisSetup rows_every(double period_s) {
  AxisSetup s;
  for (int k = 0; k < 100; ++k) s.input.time_s.push_back(k * period_s);
  return s;
}

Candidate with_typical(const char* id) {
  Candidate c = nominal();
  c.effects.push_back(typical_use(*find_effect(id)));
  return c;
}

constexpr double kShortest_s = 100e-6;

// error = 0.07 (h / h0)^2 passes at h0.
TEST(AxisSubstep, IsTheLongestWhoseErrorIsSmall) {
  const auto step = [](double h0) {
    const auto error = [h0](const Candidate&, int, double h) { return 0.0699 * h * h / (h0 * h0); };
    return AxisSubstep(nominal(), {rows_every(1e-3)}, kShortest_s, error).of(nominal(), 0);
  };
  EXPECT_DOUBLE_EQ(step(2e-3), 1e-3);
  EXPECT_DOUBLE_EQ(step(1e-3), 1e-3);
  EXPECT_DOUBLE_EQ(step(0.3e-3), 0.25e-3);
  EXPECT_DOUBLE_EQ(step(1e-5), kShortest_s);
}

TEST(AxisSubstep, OfAStiffLawFollowsFromThatLawsError) {
  const EffectEntry* bristles = find_effect("lugre_friction");
  const auto error = [&](const Candidate& c, int, double h) {
    return c.effects.empty() ? 0.0 : 0.0699 * std::pow(h / 0.25e-3, 2);
  };
  const AxisSubstep substep(nominal(), {rows_every(1e-3)}, kShortest_s, error);
  EXPECT_DOUBLE_EQ(substep.of(nominal(), 0), 1e-3);
  EXPECT_DOUBLE_EQ(substep.of(with_typical("lugre_friction"), 0), 0.25e-3);
  EXPECT_DOUBLE_EQ(substep.of(with_effect(nominal(), *bristles), 0), 1e-3) << "neutral";
  EXPECT_DOUBLE_EQ(substep.of(with_typical("backlash"), 0), kShortest_s) << "impacts have no order";
  EXPECT_DOUBLE_EQ(substep.of(with_typical("cogging"), 0), 0.25e-3);
  EXPECT_DOUBLE_EQ(substep.of(with_typical("saturation"), 0), 1e-3);
}

// In steps of more than a millisecond also a law that no numerics mark.
TEST(AxisSubstep, OfAnyLawFollowsFromItsErrorInLongSteps) {
  const auto error = [](const Candidate& c, int, double h) {
    return c.effects.empty() ? 0.0 : 0.0699 * std::pow(h / 0.5e-3, 2);
  };
  const AxisSubstep longer(nominal(), {rows_every(2e-3)}, kShortest_s, error);
  EXPECT_DOUBLE_EQ(longer.of(nominal(), 0), 2e-3);
  EXPECT_DOUBLE_EQ(longer.of(with_typical("saturation"), 0), 0.5e-3);
  EXPECT_DOUBLE_EQ(
      AxisSubstep(nominal(), {rows_every(1e-3)}, kShortest_s, error).of(with_typical("saturation"), 0), 1e-3);
}

// One size of a law that needs short steps is enough.
TEST(AxisSubstep, HoldsForEverySizeThatIsTried) {
  const EffectUse typical = typical_use(*find_effect("lugre_friction"));
  const auto error = [&](const Candidate& c, int, double h) {
    const bool soft = !c.effects.empty() && c.effects[0].values[3] < typical.values[3];
    return soft ? 0.0699 * std::pow(h / 0.125e-3, 2) : 0.0;
  };
  const AxisSubstep substep(nominal(), {rows_every(1e-3)}, kShortest_s, error);
  EXPECT_DOUBLE_EQ(substep.of(with_typical("lugre_friction"), 0), 0.125e-3);
}

// Tried down to a quarter of the typical compliance, whose mode is twice as fast: steps grow with the root of the compliance, as
// long as the damping alone does not need shorter ones.
TEST(AxisSubstep, OfASoftSpringIsLonger) {
  const auto error = [](const Candidate& c, int, double h) {
    return c.effects.empty() ? 0.0 : 0.0699 * std::pow(h / 0.125e-3, 2);
  };
  const DriveParams<double> drive = drive_of(nominal());
  const AxisSubstep substep(nominal(), {rows_every(2e-3)}, kShortest_s, error);
  const auto step = [&](double compliance_times, double damping_times) {
    Candidate c = nominal();
    c.effects.push_back(typical_use(*find_effect("shaft_compliance"), &drive));
    c.effects[0].values[0] *= compliance_times;
    c.effects[0].values[1] *= damping_times;
    return substep.of(c, 0);
  };
  EXPECT_DOUBLE_EQ(step(0.1, 1.0), 0.125e-3);
  EXPECT_DOUBLE_EQ(step(0.25, 1.0), 0.125e-3);
  EXPECT_DOUBLE_EQ(step(1.01, 1.0), 0.25e-3);
  EXPECT_DOUBLE_EQ(step(16.1, 0.25), 1e-3);
  EXPECT_DOUBLE_EQ(step(1e3, 0.25), 2e-3) << "no longer than the base model's";
  EXPECT_DOUBLE_EQ(step(16.1, 8.0), 0.125e-3) << "damping";
}

// A row a second: up to eight times the step, if that is fine enough.
TEST(AxisSubstep, IsLongerWhereRowsAreFarApart) {
  const auto fine = [](const Candidate&, int, double) { return 0.0; };
  const AxisSubstep substep(nominal(), {rows_every(1.0), rows_every(1e-3)}, kShortest_s, fine);
  EXPECT_NEAR(substep.of(nominal(), 0), 1e-3 / 0.128, 1e-12);
  EXPECT_DOUBLE_EQ(substep.of(nominal(), 1), 2e-3);  // a bound: its rows part it
}

// No longer than the rows are apart, and at most 2 ms.
TEST(AxisSubstep, IsBoundByTheRows) {
  const auto fine = [](const Candidate&, int, double) { return 0.0; };
  for (const auto& [row_s, step_s] : {std::pair{1e-3, 1e-3}, std::pair{2e-3, 2e-3}, std::pair{10e-3, 2e-3}})
    EXPECT_DOUBLE_EQ(AxisSubstep(nominal(), {rows_every(row_s)}, kShortest_s, fine).of(nominal(), 0), step_s);
}

TEST(AxisSubstep, WithNoTrialRunIsTheShortest) {
  const auto none = [](const Candidate&, int, double) { return std::numeric_limits<double>::quiet_NaN(); };
  EXPECT_DOUBLE_EQ(AxisSubstep(nominal(), {rows_every(1e-3)}, kShortest_s, none).of(nominal(), 0),
                   kShortest_s);
}

}  // namespace
}  // namespace omnihil
