// Completion of the command line for shells, from the tree of verbs.
//
//   bash_completion(program);     // share/bash-completion/completions/omnihil
//   fish_completion(program);     // share/fish/vendor_completions.d/omnihil.fish
//
// Verbs, options, and the values of options that have a list of them; names of models, radio formats and effects are
// asked of the program while one types. Where nothing else fits: file names.
#pragma once
#include <string>

#include "tools/command_tree.h"

namespace omnihil {

std::string bash_completion(const Command& program);
std::string fish_completion(const Command& program);

}  // namespace omnihil
