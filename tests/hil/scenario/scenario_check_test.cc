// Measures of checks on responses whose formula is known.
#include "hil/scenario/scenario_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hil/scenario/scenario_report.h"
#include "hil/text/json_text.h"

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

// Said at 0.2 s on USART2, at 0.3 and 0.4 s on RTT.
ScenarioRun run_that_says() {
  ScenarioRun run = run_of([](double) { return 20.0; });
  run.console = {{200'000'000, 1, 0, "USART2", "ready"},
                 {300'000'000, 1, 1, "RTT", "error 3"},
                 {400'000'000, 1, 1, "RTT", "error 4"}};
  return run;
}

TEST(ScenarioCheck, ALineIsExpectedWithinATime) {
  const ScenarioRun run = run_that_says();
  ScenarioCheck check{.kind = CheckKind::kConsoleSays, .at_most = 0.15, .text = "read"};
  const CheckResult said = one(check, run);  // from 0.1 s on
  EXPECT_TRUE(said.passed);
  EXPECT_NEAR(*said.measured, 0.1, 1e-12);
  EXPECT_EQ(said.wheel, -1);
  check.at_most = 0.05;
  EXPECT_FALSE(one(check, run).passed) << "it came too late";
  check.text = "Ready", check.at_most = 1e9;
  const CheckResult never = one(check, run);
  EXPECT_FALSE(never.passed);
  EXPECT_TRUE(never.reached);
  EXPECT_EQ(never.measured_text(), "never");
}

TEST(ScenarioCheck, ALineIsOfItsWindowItsPortAndItsBoard) {
  const ScenarioRun run = run_that_says();
  const auto at_s = [&](ScenarioCheck check) {
    const CheckResult r = one(check, run);
    return r.measured ? r.at_s : -1.0;
  };
  constexpr CheckKind kSays = CheckKind::kConsoleSays;
  EXPECT_NEAR(at_s({.kind = kSays, .text = "error"}), 0.3, 1e-12);
  EXPECT_NEAR(at_s({.kind = kSays, .from_s = 0.35, .to_s = 1.0, .text = "error"}), 0.4, 1e-12);
  EXPECT_EQ(at_s({.kind = kSays, .from_s = 0.1, .to_s = 0.25, .text = "error"}), -1.0);
  EXPECT_EQ(at_s({.kind = kSays, .text = "error", .port = "USART2"}), -1.0);
  EXPECT_EQ(at_s({.kind = kSays, .text = "error", .port = "RTT", .board = 0}), -1.0);
  EXPECT_NEAR(at_s({.kind = kSays, .text = "error", .port = "RTT", .board = 1}), 0.3, 1e-12);
}

TEST(ScenarioCheck, ALineThatMustNotComeIsCountedAndShown) {
  const ScenarioRun run = run_that_says();
  const CheckResult twice = one({.kind = CheckKind::kConsoleNeverSays, .text = "error"}, run);
  EXPECT_FALSE(twice.passed);
  EXPECT_EQ(*twice.measured, 2.0);
  EXPECT_NE(
      failure_line(twice).find(
          "console_never_says \"error\": 2, at most 0, at 0.300 s: 0.300 s robot 1 board 1 RTT | error 3"),
      std::string::npos)
      << failure_line(twice);
  EXPECT_TRUE(one({.kind = CheckKind::kConsoleNeverSays, .text = "panic"}, run).passed);
}

TEST(ScenarioCheck, ARunThatBrokeOffHasNotShownThatNothingIsSaid) {
  ScenarioRun run = run_that_says();
  run.failure = "crashed";
  ScenarioCheck check{.kind = CheckKind::kConsoleNeverSays, .from_s = 0.1, .to_s = 1.5, .text = "panic"};
  Scenario scenario;
  scenario.duration_s = 1.5;
  check.wheels[0] = true;
  scenario.checks = {check};
  CheckResult r = check_scenario(scenario, run).at(1);
  EXPECT_FALSE(r.passed);
  EXPECT_FALSE(r.reached);
  check.text = "error";  // it was said, whatever came of the run
  scenario.checks = {check};
  r = check_scenario(scenario, run).at(1);
  EXPECT_FALSE(r.passed);
  EXPECT_TRUE(r.reached);
}

TEST(ScenarioReport, TheConsoleStandsInEveryReportOfAFailedScenario) {
  ScenarioOutcome outcome;
  outcome.scenario.file = "s.toml";
  outcome.console = run_that_says().console;
  outcome.console[0].text = "<ready>";
  outcome.results.resize(1);
  outcome.results[0].name = "rise_time";
  outcome.results[0].at_s = 0.3;
  const std::string text = scenario_text(outcome, false);
  EXPECT_NE(
      text.find("  said  0.200 s robot 1 USART2 | <ready>\n  said  0.300 s robot 1 board 1 RTT | error 3\n"),
      std::string::npos)
      << text;
  EXPECT_EQ(text.find("error 4"), std::string::npos) << "it came after the check had failed";
  EXPECT_NE(junit_xml({{outcome}}).find("<system-out>0.200 s robot 1 USART2 | &lt;ready&gt;\n"),
            std::string::npos);
  const auto json = json_of(scenario_json({{outcome}}, "p"));
  EXPECT_EQ(json.at("scenarios").at(0).at("console").size(), 2u);
  EXPECT_EQ(json.at("scenarios").at(0).at("console").at(1).at("text"), "error 3");
  EXPECT_EQ(json.at("scenarios").at(0).at("checks").at(0).at("passed"), false);
  outcome.results[0].passed = true;
  EXPECT_EQ(scenario_text(outcome, false).find("said"), std::string::npos);
  EXPECT_EQ(junit_xml({{outcome}}).find("system-out"), std::string::npos);
}

}  // namespace
}  // namespace omnihil
