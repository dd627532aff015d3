// `--bench FILE` on a command line: the file's options put in its place, before anything is parsed.
//
//   std::vector<std::string> arguments{"serve", "--bench", "match.toml", "--seed", "3"};
//   std::string wrong = expand_bench(arguments, app);          // "": done, or there was nothing to do
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace omnihil {

// The file is one of serve's options whatever the verb; the verb takes those that it has, too. `replay` and `check` take only
// what a recording has not: firmware and a radio format's file.
// What is wrong with the file, a line each; the arguments are then as they were.
std::string expand_bench(std::vector<std::string>& arguments, const CLI::App& app);

}  // namespace omnihil
