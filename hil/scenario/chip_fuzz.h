// Faults in the chip at random instants of a scenario, and whether the robot stops safely all the same; of a case that
// fails, the smallest one that still does.
//
//   FuzzOutcome outcome = fuzz_scenario(scenario, suite, {.cases = 200, .seed = 7});
//   for (const FuzzFailure& f : outcome.failures) write(f.file_text);      // `scenario run` gives the same failure
//
// A case draws one to `most` faults between the first command and the radio's silence. Its check is `stops_safely` from
// the silence on; the run goes on when the firmware has failed, since motors go on, too. Smaller: faults are left out as
// long as it fails, those that last are halved, instants are rounded to milliseconds. The same seed draws the same cases.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hil/scenario/scenario_suite.h"

namespace omnihil {

struct FuzzOptions {
  std::vector<ChipFaultKind> kinds{};  // empty: all
  int cases = 100, most = 3;
  std::uint64_t seed = 1;
  double within_s = 1.0;  // after the silence it stands, or its bridges are off
};

struct FuzzFailure {
  int number = 0;                        // of the case, from 0
  std::vector<ChipFault> drawn, faults;  // as drawn; as small as it gets
  std::string why;                       // the failed check, in words
  std::string file_text;                 // a scenario
};

struct FuzzOutcome {
  int cases = 0;
  std::uint64_t runs = 0;  // those of making cases smaller, too
  std::vector<FuzzFailure> failures;
};

// std::invalid_argument: the scenario has no command or no silence, fails without a fault, or nothing can be broken.
FuzzOutcome fuzz_scenario(const Scenario& scenario, const SuiteOptions& suite, const FuzzOptions& options,
                          const std::function<void(int done)>& progress = {});

// "flip_register r4 bit 30 at 1.000123 s"
std::string fault_words(const ChipFault& fault);

}  // namespace omnihil
