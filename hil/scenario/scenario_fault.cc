#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "hil/scenario/scenario.h"
#include "hil/scenario/scenario_rows.h"

namespace omnihil {

RobotFaults faults_of(const ScenarioStep& step) {
  RobotFaults faults;
  switch (step.kind) {
    case StepKind::kDisturb:
      faults.force_forward_N = step.force_forward_N;
      faults.force_left_N = step.force_left_N;
      faults.moment_Nm = step.moment_Nm;
      break;
    case StepKind::kBrownOut:
      faults.supply_ratio = step.supply_ratio;
      break;
    case StepKind::kEncoderStuck:
      std::ranges::copy(step.wheels, faults.encoder_stuck.begin());
      break;
    case StepKind::kPhaseLost:
      std::ranges::copy(step.wheels, faults.phase_lost.begin());
      break;
    case StepKind::kWindingHot:
      for (std::size_t w = 0; w < kWheels; ++w)
        if (step.wheels[w]) faults.winding_rise_K[w] = step.rise_K;
      break;
    case StepKind::kWheelLifted:
      std::ranges::copy(step.wheels, faults.lifted.begin());
      break;
    case StepKind::kWheelBlocked:
      std::ranges::copy(step.wheels, faults.blocked.begin());
      break;
    default:
      break;
  }
  return faults;
}

// Read as the only step of a scenario, so that words, keys and limits are those.
std::optional<ScenarioStep> read_fault(std::string_view text, std::vector<std::string>& problems) {
  constexpr double kScenario_s = 600.0;
  const auto no_line = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
  if (std::ranges::any_of(text, no_line)) {
    problems.push_back("a fault is one line");
    return std::nullopt;
  }
  const std::string scenario = fmt::format(
      "format = \"omnihil-scenario/1\"\ntitle = \"fault\"\nduration_s = {}\nstep = [{{ {} }}]\n"
      "check = [{{ is = \"control_periods\", at_most_count = 0 }}]\n",
      kScenario_s, text);
  const ScenarioReading reading = read_scenario(scenario, "fault");
  constexpr std::string_view kStep = "step[1].";
  const bool of_step = std::ranges::any_of(
      reading.problems, [&](const ModelProblem& problem) { return problem.key.starts_with(kStep); });
  for (ModelProblem problem : reading.problems) {
    if (of_step && !problem.key.starts_with(kStep)) continue;  // it only follows from the others
    // The place in a text that nobody has written says nothing.
    problem.file.clear();
    problem.line = problem.column = 0;
    if (problem.key.starts_with(kStep)) problem.key.erase(0, kStep.size());
    std::string words = problem.text();
    words.erase(0, words.find_first_not_of(": "));
    problems.push_back(words);
  }
  if (!reading.scenario) return std::nullopt;
  if (reading.scenario->steps.size() != 1) {
    problems.push_back("is one step");
    return std::nullopt;
  }
  ScenarioStep step = reading.scenario->steps.front();
  if (!row_of(step.kind).lasts) {
    std::string allowed;
    for (const StepRow& row : step_rows())
      if (row.lasts && row.kind != StepKind::kChip)  // a scenario alone breaks chips
        allowed += (allowed.empty() ? "" : ", ") + std::string(row.word);
    problems.push_back(fmt::format("do = \"{}\" is no fault, allowed: {}", row_of(step.kind).word, allowed));
    return std::nullopt;
  }
  if (step.until_s >= kScenario_s) step.until_s = std::numeric_limits<double>::infinity();
  return step;
}

}  // namespace omnihil
