// A bench as a file: what the options of `serve` say, in TOML. `serve --bench match.toml` is `serve` with those options.
//
//   format    = "omnihil-bench/1"
//   model     = "my_robot.toml"        # --robot (which is a key as well); names of files are looked for beside this file first
//   robots    = "0-5"
//   firmware  = "build/libfw.so"
//   with      = ["battery_sag", "floor_tilt"]
//   [league]                           # --league; keys below are --league-…
//   sync = 10304
//   [air]
//   loss = 2                           # --air-loss
//   [[robot]]                          # one robot: bench_robots.h
//   id = 3
//   [[fault]]                          # something that goes wrong at an instant
//   robots = 3
//
// A key is an option's name, with _ or - between words; a table is its first word. true sets a flag, a list gives an
// option several times. What stands on the command line, too, is taken from there. Unknown keys are named with line and
// nearest spelling; values are judged as on the command line. Every table of a robot or a fault is an option, too, so a file
// says nothing that a command line cannot: bench_text.h prints one from the other.
#pragma once
#include <set>
#include <span>
#include <string>
#include <vector>

#include "sim/model/model_file.h"

namespace omnihil {

inline constexpr const char* kBenchFormat = "omnihil-bench/1";

struct BenchOption {
  std::string name;  // without the dashes: "sample-every"
  bool is_flag = false;
};

struct BenchArguments {
  std::vector<std::string> arguments;  // "--robots", "0-5", …
  std::vector<ModelProblem> problems;
};

// `given`: names of options that stand on the command line. `folder`: of the file; "" is the current one.
BenchArguments bench_arguments(const std::string& text, const std::string& file, const std::string& folder,
                               std::span<const BenchOption> options, const std::set<std::string>& given);

}  // namespace omnihil
