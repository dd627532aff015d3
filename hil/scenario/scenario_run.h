// One scenario from start to end in virtual time, with any firmware.
//
//   ScenarioRun run = run_scenario(scenario, config, open_firmware(choice, config));
//   run.trace.column("omega_wheel_rad_s", 0);
//
// Order at each millisecond: steps that begin or end, then the host's packet if one is due, then the loop.
// A pure function of its arguments: the same bits every time, at any load of this computer.
#pragma once
#include <string>

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
};

// `config` has one robot. std::invalid_argument: the configuration, or a command that the path of the
// scenario cannot carry.
ScenarioRun run_scenario(const Scenario& scenario, const SessionConfig& config,
                         const Session::FirmwareMaker& make_firmware);

}  // namespace omnihil
