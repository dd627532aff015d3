#include "tools/options/replay_words.h"

#include "hil/loop/effect_overrides.h"
#include "hil/loop/session_checks.h"
#include "hil/recording/recording_header.h"
#include "hil/recording/session_setup.h"
#include "hil/text/program_files.h"
#include "tools/options/firmware_options.h"

namespace omnihil {

void add_replay_options(Verb& verb, ReplayWords& words) {
  verb.add_option(
      "--bench", words.bench,
      "firmware (and a radio format's file) as this bench file says (docs/bench.md); what is given "
      "here wins");
  verb.add_option("--format", words.format_file,
                  "radio format of the recording from this file, where it was made with one");
  add_team_firmware_options(verb, words.firmware);
  verb.add_option("--robot", words.robot, "robot model instead of the recorded one, by name or path");
  verb.add_option(
      "--with", words.with,
      "add an effect to every robot: ID.parameter=value, or ID for its typical size; several allowed");
  verb.add_option("--physics", words.physics, "instead of the recorded one: simbody, planar or simbody-free")
      .one_of({"simbody", "planar", "simbody-free"});
  verb.add_option("--seed", words.seed, "of everything random, instead of the recorded one");
}

ReplayOptions replay_options(const ReplayWords& words, const RecordingHeader& recorded) {
  ReplayOptions options;
  std::vector<std::string> problems;
  options.physics = parse_physics(words.physics);
  options.seed = words.seed;
  if (!words.robot.empty()) {
    const StoredModel stored = load_robot_model(words.robot, {data_folder("models")});
    for (const ModelProblem& problem : stored.problems) problems.push_back(problem.text());
    options.model = stored.bundle;
  }
  if (!words.with.empty() && problems.empty()) {
    if (!options.model && !recorded.other_robots.empty())
      problems.push_back("--with: the recording has robots of several models; name one with --robot");
    if (!options.model) options.model = session_setup(recorded).model;
    add_effects(*options.model, words.with, problems);
  }
  throw_problems(problems);
  options.firmware_files = team_firmware_files(words.firmware);
  if (words.firmware.names_any()) {
    options.firmware = [all = words.firmware](const SessionConfig& config) {
      return open_first_firmware(all, config);
    };
    options.opponents_firmware = [all = words.firmware](const SessionConfig& alone) {
      return open_opponents_firmware(all, alone);
    };
  }
  if (const std::string missing = firmware_missing(recorded, options); !missing.empty())
    throw std::invalid_argument(missing);
  return options;
}

}  // namespace omnihil
