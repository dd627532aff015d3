// The verbs of `omnihil`. One file per verb; CMake collects the file stems, so a file added is a verb added:
// tools/verbs/NAME.cc defines `void add_verb_NAME(CLI::App&, VerbResult&)`.
#pragma once
#include <span>

namespace CLI {
class App;
}

namespace omnihil {

// Set by the callback of the verb that ran.
struct VerbResult {
  int exit_code = 0;
};

// Adds a verb to the program.
using VerbAdder = void(CLI::App& app, VerbResult& result);

// Of every verb, in alphabetical order (generated).
std::span<VerbAdder* const> all_verbs();

}  // namespace omnihil
