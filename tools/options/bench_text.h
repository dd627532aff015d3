// The options of a verb, with all values that they have, as a bench file: what `serve --print-bench` prints and a recording
// keeps.
//
//   const std::string text = bench_text(verb.settings());       // "format = \"omnihil-bench/1\"\nrobot = …"
//
// Read again (bench_file.h) it gives the same values.
#pragma once
#include <span>
#include <string>

#include "tools/command_line.h"

namespace omnihil {

std::string bench_text(std::span<const OptionSetting> settings);

}  // namespace omnihil
