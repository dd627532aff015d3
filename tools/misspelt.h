// What a user who mistyped a verb or an option probably meant, after the command line was refused.
//
//   omnihil srve             omnihil: there is no verb "srve"; did you mean "serve"?
//   omnihil serve --robts 1  omnihil serve: there is no option --robts; did you mean --robots?
#pragma once
#include <string>

#include "tools/command_tree.h"

namespace omnihil {

// A line for each verb or option that does not exist, with the nearest one that does; empty when all exist.
std::string misspelt_words(const Command& program);

}  // namespace omnihil
