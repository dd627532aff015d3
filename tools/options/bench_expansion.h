// `--bench FILE` on a command line: the file's options put in its place, before anything is parsed.
//
//   std::vector<std::string> arguments{"serve", "--bench", "match.toml", "--seed", "3"};
//   std::string wrong = expand_bench(arguments, app);          // "": done, or there was nothing to do
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace omnihil {

// What is wrong with the file, a line each; the arguments are then as they were.
std::string expand_bench(std::vector<std::string>& arguments, const CLI::App& app);

}  // namespace omnihil
