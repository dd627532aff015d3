// The verbs of `omnihil`. One file per verb; CMake collects the file stems, so a file added is a verb added:
// tools/verbs/NAME.cc defines `void add_verb_NAME(Verb& program, VerbResult&)`.
#pragma once
#include <span>

#include "tools/command_line.h"

namespace omnihil {

// Set by the callback of the verb that ran.
struct VerbResult {
  int exit_code = 0;
};

// Adds a verb to the program.
using VerbAdder = void(Verb& program, VerbResult& result);

// Of every verb, in alphabetical order (generated).
std::span<VerbAdder* const> all_verbs();

}  // namespace omnihil
