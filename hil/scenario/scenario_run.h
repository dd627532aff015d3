// One scenario from start to end in virtual time, with any firmware.
//
//   ScenarioRun run = run_scenario(scenario, config, open_firmware(choice, config));
//   run.trace.column("omega_wheel_rad_s", 0);
//
// Order at each millisecond: steps that begin or end, then the host's packet if one is due, then the loop.
// A pure function of its arguments: the same bits every time, at any load of this computer.
#pragma once
#include <string>
#include <vector>

#include "hil/loop/console_line.h"
#include "hil/loop/session.h"
#include "hil/scenario/scenario.h"
#include "hil/scenario/scenario_signals.h"

namespace omnihil {

struct ScenarioRun {
  ScenarioTrace trace;
  std::string firmware;  // its name
  std::string commands;  // how commands reached it
  std::string
      failure;  // the firmware answers no more, or a state is not finite: when and why; empty: neither
  bool firmware_failed = false;
  std::vector<ConsoleLine> console;  // what its boards said
  // Of an emulated chip: what of it was in use.
  std::vector<ChipMemoryRange> ram_in_use, flash_in_use;
  std::vector<int> interrupts_in_use;
};

// Variables of the firmware by name (hil/variables/), besides those that the scenario itself names.
struct ScenarioVariables {
  std::string file;                // that the firmware comes from
  std::vector<std::string> watch;  // for the trace
  std::vector<std::string> set;    // "NAME=VALUE", at the start
};

// Who hears the robot's boards and types at them, and whether one of them has a console, and one that reads.
struct ScenarioConsole {
  ConsoleKeeper keeper;
  bool there = false, reads = false;
  std::string typed;  // since the start
};

// `config` has one robot. std::invalid_argument: the configuration, or a command that the path of the
// scenario cannot carry, or variables or a console that are not there.
ScenarioRun run_scenario(const Scenario& scenario, const SessionConfig& config,
                         const Session::FirmwareMaker& make_firmware, const ScenarioVariables& variables = {},
                         ScenarioConsole* console = nullptr);

}  // namespace omnihil
