// Published recordings of torque-driven axes: the torque (force) that the measured motion takes, against the
// one that was given. Published figures: relative force error in percent, residual torque in mN m.
#include "tests/identify/real_bench.h"

namespace omnihil {
namespace {

class RealTorque : public RealTest {};

double number(const FitResult& r, const std::string& path) { return value_at(r.model, path).value_or(NAN); }

TEST_F(RealTorque, TheLinearAxisHasItsPublishedNumbers) {
  // published: mass 95.1 kg, viscous 203.5 N s/m, Coulomb 20.4 N, offset 3.2 N; delay 0.33 ms
  const RealSet emps("emps");
  const FitResult r = emps.fitted({"coulomb_friction", "constant_load"});
  EXPECT_NEAR(number(r, "load.mass_kg"), 95.1, 0.5);
  EXPECT_NEAR(number(r, "motor.viscous_friction_N_s_per_m"), 203.5, 8.0);
  EXPECT_NEAR(number(r, "coulomb_friction.torque_N"), 20.4, 0.8);
  EXPECT_NEAR(number(r, "constant_load.torque_N"), 3.2, 0.3);
  const FitResult delayed =
      emps.fitted({"coulomb_friction", "constant_load", "friction_asymmetry", "actuator_delay"});
  EXPECT_NEAR(number(delayed, "actuator_delay.delay_s"), 0.33e-3, 0.05e-3);
}

TEST_F(RealTorque, EachFrictionOfTheLinearAxisLowersTheForceErrorAsPublished) {
  // published ladder, relative to viscous friction alone (17.95 %): 7.11, 4.039, 3.058
  const RealSet emps("emps");
  const auto error = [&](const std::vector<std::string>& effects) {
    return emps.rmse(emps.fitted(effects).model, Split::kTraining, "motor_torque");
  };
  const double viscous = error({});
  EXPECT_NEAR(error({"coulomb_friction"}) / viscous, 7.11 / 17.95, 0.03);
  EXPECT_NEAR(error({"coulomb_friction", "constant_load"}) / viscous, 4.039 / 17.95, 0.03);
  EXPECT_NEAR(error({"coulomb_friction", "constant_load", "friction_asymmetry"}) / viscous, 3.058 / 17.95,
              0.03);
}

TEST_F(RealTorque, AsymmetryAndOffsetTradeOnTheLinearAxis) {
  const RealSet emps("emps");
  const FitResult r = emps.fitted({"coulomb_friction", "constant_load", "friction_asymmetry"});
  for (const ParameterEstimate& p : r.parameters) {
    const bool traded = p.path == "constant_load.torque_N" || p.path == "friction_asymmetry.coulomb_ratio";
    EXPECT_EQ(p.identifiable, !traded) << p.path;
  }
}

TEST_F(RealTorque, TheBrushlessMotorLeavesItsPublishedResidualWithoutItsCogging) {
  // published, speed runs: 6.07 / 6.26 mN m; standstill map as measured 4.01
  const RealSet laas("laas_mn4004");
  const Candidate c = laas.fitted({}).model;
  expect_same(laas.rmse(c, Split::kTraining, "motor_torque"), 6.07e-3, 0.06);
  expect_same(laas.rmse(c, Split::kValidation, "motor_torque"), 6.26e-3, 0.06);
  expect_same(laas.rmse(c, Split::kTraining, "motor_torque", true), 4.01e-3, 0.02);
}

TEST_F(RealTorque, CoggingOfTheBrushlessMotorIsFoundInMapAndMotionAlike) {
  // published best, speed runs: 2.17 / 3.26
  const RealSet laas("laas_mn4004");
  const Candidate c =
      laas.fitted({"coulomb_friction", "cogging", "cogging.order=72", "actuator_delay"}).model;
  expect_at_most(laas.rmse(c, Split::kTraining, "motor_torque"), 2.17e-3, 0.0);
  expect_at_most(laas.rmse(c, Split::kValidation, "motor_torque"), 3.26e-3, 0.0);
}

}  // namespace
}  // namespace omnihil
