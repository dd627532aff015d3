// Manual pages and shell completion as files, for an installation (cmake/install.cmake calls `omnihil manual`).
//
//   write_manual(command_tree(app), "0.1.0", "build/manual");   // build/manual/share/man/man1/omnihil.1, …
#pragma once
#include <string>

#include "tools/command_tree.h"

namespace omnihil {

// Below `folder`/share as an installation has them. Throws std::system_error with the file's name.
void write_manual(const Command& program, const std::string& version, const std::string& folder);

}  // namespace omnihil
