// Programs that stand beside this one and are run as processes of their own: where they are, and how one
// ended.
#pragma once
#include <string>

namespace omnihil {

// Beside this program, else at `built` (where the build put it), else by name on the search path.
std::string child_program(const std::string& name, const std::string& built);
std::string signal_words(int signal);

}  // namespace omnihil
