// Measures of checks on responses whose formula is known.
#include "hil/scenario/scenario_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace omnihil {
namespace {

constexpr double kStep_s = 1e-3;

// y(t) of wheel 0 from 0.1 s on, commanded 20 rad/s from there; duty and current follow it.
template <class F>
ScenarioRun run_of(F&& y) {
  ScenarioRun run;
  for (int n = 0; n < 1000; ++n) {
    const double t_s = n * kStep_s;
    ScenarioSample s;
    s.wanted_wheel_rad_s.fill(t_s >= 0.1 - 1e-9 ? 20.0 : 0.0);
    s.robot.truth.omega_wheel_rad_s[0] = t_s < 0.1 ? 0.0 : y(t_s - 0.1);
    s.robot.truth.motor_current_A[0] = s.robot.truth.omega_wheel_rad_s[0] / 2.0;
    s.missed_periods = t_s > 0.5 ? 2 : 0;
    run.trace.add(t_s, s);
  }
  return run;
}

CheckResult one(ScenarioCheck check, const ScenarioRun& run) {
  check.wheels = {true, false, false, false};
  if (check.to_s == 0.0) check.from_s = 0.1, check.to_s = 1.0;
  if (check.kind <= CheckKind::kCommandedSign) check.signal = "omega_wheel_rad_s";
  if (!check.at_most) check.at_most = 1e9;
  Scenario scenario;
  scenario.duration_s = 1.0;
  scenario.checks = {check};
  return check_scenario(scenario, run).at(0);
}

TEST(ScenarioCheck, FirstOrderResponse) {
  constexpr double kTau_s = 0.05;
  const ScenarioRun run = run_of([](double t) { return 20.0 * (1.0 - std::exp(-t / kTau_s)); });
  // 1 - e^(-t/tau) = 0.9
  EXPECT_NEAR(*one({.kind = CheckKind::kRiseTime}, run).measured, kTau_s * std::log(10.0), kStep_s);
  // e^(-t/tau) = 0.05
  EXPECT_NEAR(*one({.kind = CheckKind::kSettlingTime}, run).measured, kTau_s * std::log(20.0), kStep_s);
  EXPECT_EQ(*one({.kind = CheckKind::kOvershoot}, run).measured, 0.0);
  EXPECT_NEAR(*one({.kind = CheckKind::kSteadyError}, run).measured, 0.0, 1e-5);
}

TEST(ScenarioCheck, SecondOrderOvershoot) {
  constexpr double kZeta = 0.4, kOmega = 40.0;
  const double root = std::sqrt(1.0 - kZeta * kZeta);
  const ScenarioRun run = run_of([&](double t) {
    const double a = kOmega * root * t;
    return 20.0 * (1.0 - std::exp(-kZeta * kOmega * t) * (std::cos(a) + kZeta / root * std::sin(a)));
  });
  // exp(-pi zeta / sqrt(1 - zeta^2)) at t = pi / (omega sqrt(1 - zeta^2))
  const CheckResult r = one({.kind = CheckKind::kOvershoot}, run);
  EXPECT_NEAR(*r.measured, std::exp(-std::numbers::pi * kZeta / root), 1e-3);
  EXPECT_NEAR(r.at_s, 0.1 + std::numbers::pi / (kOmega * root), kStep_s);
}

TEST(ScenarioCheck, WheelThatNeverArrivesFailsRiseAndSettling) {
  const ScenarioRun run = run_of([](double) { return 10.0; });
  for (const CheckKind kind : {CheckKind::kRiseTime, CheckKind::kSettlingTime}) {
    const CheckResult r = one({.kind = kind, .at_most = 5.0}, run);
    EXPECT_FALSE(r.passed);
    EXPECT_FALSE(r.measured);
  }
  EXPECT_NEAR(*one({.kind = CheckKind::kSteadyError}, run).measured, 0.5, 1e-12);
}

TEST(ScenarioCheck, WrongDirectionFailsTheSignAlone) {
  const ScenarioRun run = run_of([](double) { return -20.0; });
  const CheckResult r = one({.kind = CheckKind::kCommandedSign}, run);
  EXPECT_FALSE(r.passed);
  EXPECT_NEAR(*r.measured, -20.0, 1e-12);
  EXPECT_TRUE(one({.kind = CheckKind::kCommandedSign}, run_of([](double) { return 5.0; })).passed);
}

TEST(ScenarioCheck, StandstillIsTheLastInstantThatTurned) {
  const ScenarioRun run = run_of([](double t) { return t < 0.3 ? 20.0 : 0.5; });
  const CheckResult r =
      one({.kind = CheckKind::kStopsAfterSilence, .from_s = 0.2, .to_s = 1.0, .at_most = 1.0}, run);
  EXPECT_NEAR(*r.measured, 0.2, kStep_s);  // silence at 0.2 s, still at 0.4 s
  EXPECT_TRUE(r.passed);
  EXPECT_FALSE(one({.kind = CheckKind::kStopsAfterSilence, .to_s = 0.4, .at_most = 1.0}, run).passed);
}

TEST(ScenarioCheck, LimitsCountsAndBounds) {
  const ScenarioRun run = run_of([](double t) { return 20.0 - 30.0 * t; });  // 20 to -7
  EXPECT_NEAR(*one({.kind = CheckKind::kCurrentLimit}, run).measured, 10.0, 1e-9);
  EXPECT_EQ(*one({.kind = CheckKind::kControlPeriods, .at_most = 0.0}, run).measured, 2.0);
  EXPECT_FALSE(one({.kind = CheckKind::kControlPeriods, .at_most = 0.0}, run).passed);
  ScenarioCheck bounds{.kind = CheckKind::kSignal, .from_s = 0.1, .to_s = 1.0, .signal = "omega_wheel_rad_s"};
  bounds.wheels = {true, false, false, false};
  bounds.at_most = 21.0;
  bounds.at_least = -5.0;
  Scenario scenario;
  scenario.checks = {bounds};
  const std::vector<CheckResult> both = check_scenario(scenario, run);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_TRUE(both[0].passed);
  EXPECT_FALSE(both[1].passed);  // -6.97 at the end
  EXPECT_NEAR(*both[1].measured, 20.0 - 30.0 * 0.899, 1e-9);
}

}  // namespace
}  // namespace omnihil
