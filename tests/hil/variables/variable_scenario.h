// A scenario of wheels that turn at 20 rad/s from 0.1 s on, with what a test of variables by name adds to it.
//
//   const ScenarioOutcome outcome = outcome_of("[[check]]\nis = \"signal\"\n…", {.file = image, .board = board}, {"gain=2"});
//   EXPECT_TRUE(outcome.passed()) << failures(outcome);
#pragma once
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "hil/firmware/open_firmware.h"
#include "hil/scenario/scenario_suite.h"

namespace omnihil {

inline ScenarioOutcome outcome_of(const std::string& steps_and_checks, const FirmwareChoice& firmware,
                                  const std::vector<std::string>& set = {}, const std::string& robot = {}) {
  const std::string text =
      "format = \"omnihil-scenario/1\"\ntitle = \"variables\"\nstand = true\nduration_s = 0.6\n"
      "[[step]]\nat_s = 0.1\ndo = \"command\"\nomega_wheel_rad_s = 20.0\n" +
      steps_and_checks;
  const ScenarioReading reading = read_scenario(text, "variables.toml");
  for (const ModelProblem& problem : reading.problems) ADD_FAILURE() << problem.text();
  SuiteOptions options;
  options.firmware = firmware;
  options.set = set;
  if (!robot.empty()) options.robot = robot;
  options.model_folders = {OMNIHIL_SOURCE_DIR "/models"};
  return run_one(*reading.scenario, options);
}

inline std::string failures(const ScenarioOutcome& outcome) {
  std::string text;
  for (const CheckResult& r : outcome.results) text += r.passed ? "" : failure_line(r) + "\n";
  return text;
}

// What is said where `run` is refused.
template <typename Run>
std::string refusal_of(Run run) {
  try {
    run();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

}  // namespace omnihil
