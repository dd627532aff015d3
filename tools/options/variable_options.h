// The options with which a verb lets its user name variables of the firmware: the same words for all of them.
//
//   add_variable_options(verb, watch, set);           // --watch NAME, --set NAME=VALUE
#pragma once
#include <string>
#include <vector>

#include "tools/command_line.h"

namespace omnihil {

void add_variable_options(Verb& verb, std::vector<std::string>& watch, std::vector<std::string>& set);

}  // namespace omnihil
