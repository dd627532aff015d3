// The options with which a verb lets its user put something else in the place of what was recorded.
//
//   add_replay_options(verb, words);               // --firmware …, --robot, --with, --physics, --seed, --format
//   ReplayOptions options = replay_options(words, recording.header);
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "hil/recording/replay_run.h"
#include "tools/command_line.h"
#include "tools/options/firmware_options.h"

namespace omnihil {

struct ReplayWords {
  TeamFirmwareWords firmware;
  std::string robot;              // model by name or path; empty: the recorded one
  std::vector<std::string> with;  // effects, over the recorded or the named model
  std::string physics;
  std::string format_file;
  std::string bench;  // expanded before the command line is read (bench_expansion.h)
  std::optional<std::uint64_t> seed;
};

void add_replay_options(Verb& verb, ReplayWords& words);

// Throws std::invalid_argument with every problem, a line each.
ReplayOptions replay_options(const ReplayWords& words, const RecordingHeader& recorded);

}  // namespace omnihil
