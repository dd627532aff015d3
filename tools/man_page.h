// Manual pages from the tree of verbs, in the words of `--help`, in the man macros of roff.
//
//   man_page(program, "0.1.0");            // omnihil(1)
//   man_page(program.verbs[0], "0.1.0");   // omnihil-add(1); a verb's own verbs are sections of its page
#pragma once
#include <string>

#include "tools/command_tree.h"

namespace omnihil {

std::string man_page(const Command& command, const std::string& version);
std::string man_page_name(const Command& command);  // "omnihil-add"

}  // namespace omnihil
