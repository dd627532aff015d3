// Scenario files as a user names them, run one after another with one firmware.
//
//   SuiteReading suite = read_suite({"wheel", "mine.toml"}, "", "examples/scenarios");
//   for (const Scenario& s : suite.scenarios) outcomes.push_back(run_one(s, options));
#pragma once
#include <string>
#include <vector>

#include "hil/debugger/gdb_server.h"
#include "hil/firmware/open_firmware.h"
#include "hil/scenario/scenario_report.h"

namespace omnihil {

struct SuiteReading {
  std::vector<Scenario> scenarios;  // by file name; only without problems
  std::vector<std::string> problems;
};

// `paths`: files, folders (every .toml in them and below), or what stands under `shipped` by the same names
// ("wheel", "wheel/direction"); none: all that is shipped. `level`: "wheel" or "robot" alone; empty: both.
SuiteReading read_suite(const std::vector<std::string>& paths, const std::string& level,
                        const std::string& shipped = "");

struct SuiteOptions {
  FirmwareChoice firmware;
  std::string robot;              // instead of the scenarios' own
  std::string radio;              // instead of the robot model's
  std::vector<std::string> with;  // effects
  std::vector<std::string> model_folders;
  Physics physics = Physics::kPlanar;
  std::uint64_t seed = 0;
  GdbServer* gdb = nullptr;             // not owned; firmware.listeners adds to it
  std::string plots;                    // folder for the plots of failed checks; empty: none
  std::vector<std::string> watch, set;  // variables of the firmware, and "NAME=VALUE" at the start
  std::string csv;                      // folder for one table of all signals per scenario; empty: none
};

// The run alone, with robot, firmware and the rest as they are asked for.
ScenarioRun run_of(const Scenario& scenario, const SuiteOptions& options);
// std::invalid_argument: robot, effects, radio or firmware cannot be used. std::system_error: a plot cannot
// be written.
ScenarioOutcome run_one(const Scenario& scenario, const SuiteOptions& options);

}  // namespace omnihil
