// What came of scenarios: lines for people, JUnit XML for machines.
//
//   std::fputs(scenario_text(outcome, false).c_str(), stdout);
//   std::string xml = junit_xml(outcomes);
#pragma once
#include <span>
#include <string>
#include <vector>

#include "hil/scenario/scenario_check.h"

namespace omnihil {

struct ScenarioOutcome {
  Scenario scenario;
  std::string firmware, commands;
  std::vector<CheckResult> results;
  bool firmware_failed = false;
  std::string plot;                  // file; empty: none
  std::vector<ConsoleLine> console;  // what the robot's boards said

  bool passed() const;
};

// One block; `all`: passed checks too, else the failed ones alone. Where one has failed, the console's last lines, too.
std::string scenario_text(const ScenarioOutcome& outcome, bool all);
// "rise_time wheel 2: 0.412 s, at most 0.3 s, at 0.512 s (line 14)"
std::string failure_line(const CheckResult& result);
std::string summary_line(std::span<const ScenarioOutcome> outcomes);
// testsuites / testsuite per file / testcase per check and wheel; the console of a failed one as its system-out. Times
// are of the simulated robot.
std::string junit_xml(std::span<const ScenarioOutcome> outcomes);
// One object: program, scenarios with every check's numbers, and the console of those that failed.
std::string scenario_json(std::span<const ScenarioOutcome> outcomes, const std::string& program);

}  // namespace omnihil
