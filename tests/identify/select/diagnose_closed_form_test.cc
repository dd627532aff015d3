// The whole way from a record to a verdict, where the answer is a mean of torques.
#include <gtest/gtest.h>

#include "identify/select/diagnosis.h"
#include "tests/identify/torque_map.h"

namespace omnihil {
namespace {

std::string reasons(const Diagnosis& d) {
  std::string out = d.unknown.sentence + "\n";
  for (const DataFinding& f : d.findings) out += f.sentence + "\n";
  for (const RankedEffect& r : d.ranking) out += r.effect + ": " + r.why + "\n";
  return out;
}

TEST(DiagnoseTest, NamesALoadAndMeasuresIt) {
  const double load_Nm = 0.004, sigma_Nm = 1e-4;
  const TorqueMap map({.load_Nm = load_Nm, .sigma_Nm = sigma_Nm});
  const Diagnosis d = diagnose(map.dataset, map.nominal, {});
  ASSERT_EQ(d.effects, std::vector<std::string>{"constant_load"}) << reasons(d);
  EXPECT_EQ(d.verdict, Verdict::kEffect) << reasons(d);
  // Speeds are symmetric, so the load is the mean torque, less its own prior's pull (1e-6 of it).
  double mean = 0.0;
  for (int i = 0; i < TorqueMap::kPoints; ++i)
    mean += map.without_brake_Nm(kTraining, i) / TorqueMap::kPoints;
  EXPECT_NEAR(value_at(d.final_fit.model, kLoad).value(), -mean, 1e-3 * load_Nm);
  // the ladder: as given, base refitted, with the load; what is left is the noise
  ASSERT_EQ(d.ladder.size(), 3u);
  EXPECT_EQ(d.ladder[2].added, "constant_load");
  EXPECT_NEAR(d.final_comparison.error(kValidation, "motor_torque")->rmse / sigma_Nm, 1.0,
              5.0 / std::sqrt(2.0 * TorqueMap::kPoints));
  EXPECT_NEAR(d.baseline_comparison.error(kValidation, "motor_torque")->rmse, std::hypot(load_Nm, sigma_Nm),
              5.0 * sigma_Nm / std::sqrt(TorqueMap::kPoints));
}

TEST(DiagnoseTest, NamesNothingWhereTheBaseModelIsTheTruth) {
  const TorqueMap map({});
  const Diagnosis d = diagnose(map.dataset, map.nominal, {});
  EXPECT_EQ(d.effects, std::vector<std::string>{}) << reasons(d);
  EXPECT_EQ(d.verdict, Verdict::kAdequate) << reasons(d);
  EXPECT_TRUE(d.complete);
  EXPECT_EQ(d.ladder.size(), 2u);
}

// A model of which every number is known leaves nothing to fit but the effect. The load is the mean torque, as above.
TEST(DiagnoseTest, NamesALoadOfAModelThatIsKnownExactly) {
  const double load_Nm = 0.004, friction_Nm_s_per_rad = 1.3e-5;
  const TorqueMap map({.friction_Nm_s_per_rad = friction_Nm_s_per_rad, .load_Nm = load_Nm});
  const Diagnosis d = diagnose(map.dataset, axis_with_friction("1.3e-5"), {});
  ASSERT_EQ(d.effects, std::vector<std::string>{"constant_load"}) << reasons(d);
  double mean = 0.0;
  for (int i = 0; i < TorqueMap::kPoints; ++i)
    mean += map.without_brake_Nm(kTraining, i) / TorqueMap::kPoints;
  EXPECT_NEAR(value_at(d.final_fit.model, kLoad).value(), -mean, 1e-3 * load_Nm);
}

// Only ever driving, a loss in proportion to the measured torque would shrink the whole equation with its noise.
TEST(DiagnoseTest, NamesNoLossThatExplainsTheMeasurementByItself) {
  const TorqueMap map({.braked = false});
  const Diagnosis d = diagnose(map.dataset, map.nominal, {});
  EXPECT_EQ(d.effects, std::vector<std::string>{}) << reasons(d);
  EXPECT_EQ(d.verdict, Verdict::kAdequate) << reasons(d);
}

// Held-out runs are of the fit runs' kind. What only another kind of run shows is no less missing.
TEST(DiagnoseTest, WhatOnlyRunsOfAnotherKindShowIsSaid) {
  const TorqueMap map({.another = true, .swing_Nm = 1e-3});
  const Diagnosis d = diagnose(map.dataset, map.nominal, {});
  EXPECT_EQ(d.effects, std::vector<std::string>{}) << reasons(d);
  EXPECT_EQ(d.verdict, Verdict::kUnknown) << reasons(d);
  // sqrt(1e-4^2 + 1e-3^2 / 2) = 7.14e-4 N m
  EXPECT_NE(d.unknown.sentence.find("0.000713 N m RMS of motor_torque on extrapolation runs"),
            std::string::npos)
      << reasons(d);
}

TEST(DiagnoseTest, ARunOfAnotherKindThatTheModelExplainsChangesNothing) {
  const TorqueMap map({.another = true});
  const Diagnosis d = diagnose(map.dataset, map.nominal, {});
  EXPECT_EQ(d.verdict, Verdict::kAdequate) << reasons(d);
  EXPECT_EQ(d.unknown.sentence.find("extrapolation"), std::string::npos) << reasons(d);
}

// At a thousandth of the speed friction is not seen (1.3e-5 x 0.3 rad/s against 1e-4 N m), at full speed the belief's error is.
TEST(DiagnoseTest, AParameterThatTheFitRunsDoNotTellIsNoStructure) {
  const TorqueMap map(
      {.friction_Nm_s_per_rad = 1.6e-5, .braked = false, .share_of_speed = 1e-3, .another = true});
  const Diagnosis d = diagnose(map.dataset, map.nominal, {});
  EXPECT_EQ(d.verdict, Verdict::kAdequate) << reasons(d);
  EXPECT_NE(d.unknown.sentence.find("the fit runs do not tell them"), std::string::npos) << reasons(d);
}

}  // namespace
}  // namespace omnihil
