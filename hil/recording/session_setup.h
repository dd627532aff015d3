// From what a user names (a model, a radio format, robot ids) to a session that runs, and to the header of a
// recording that says it all again: serve and replay build the same session from the same words.
//
//   SessionSetup setup;
//   setup.model = load_robot_model("ulaval_2024", folders).bundle;
//   setup.radio_format = "ulaval-hermes";
//   setup.robot_ids = parse_robot_list("0-5", problems);
//   SessionConfig config = session_config(setup);
//   Session session(config, reference_firmware_for(config));
//
//   RecordingHeader header = recording_header(setup, commit);
//   SessionSetup again = session_setup(header);     // again's session_config() is the same
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "hil/loop/model_store.h"
#include "hil/loop/session.h"
#include "hil/recording/recording.h"

namespace omnihil {

// Robots of another model than the session's.
struct OtherModel {
  std::vector<int> keys;  // ids, ascending; opponents: kOpponentKey + id
  ModelBundle model;
  bool operator==(const OtherModel&) const = default;
};

struct SessionSetup {
  ModelBundle model;               // of all robots but these:
  std::vector<OtherModel> others;  // each key at most once
  std::string radio_format;
  std::vector<int> robot_ids;  // ascending
  Team team = Team::kBlue;
  PlantOptions plant;
  std::int64_t step_ns = 1'000'000;
  std::uint64_t epoch_ms = 1'700'000'000'000;
  AirOptions air;
  FieldSetup field;
  std::vector<int> opponent_ids;  // of the same model; none: no other team
  std::string opponents_radio;    // of their dongle; empty: none
  std::vector<TimedFault> faults;
  double spread = 0.0;             // of each robot's numbers, in tolerances of the model (model_spread.h)
  std::vector<std::uint8_t> from;  // the world at the start (SessionConfig::from)
};

// Reads the model from its texts; throws std::invalid_argument with every problem, a line each.
SessionConfig session_config(const SessionSetup& setup);

// `firmware`, `firmware_files`, `started` and the columns are left to the caller and the writer.
RecordingHeader recording_header(const SessionSetup& setup, const std::string& commit);
SessionSetup session_setup(const RecordingHeader& header);
// The model of all robots of `header` replaced, its name and its texts.
void set_model(RecordingHeader& header, const ModelBundle& model);

// "3,4": robots of the first team; "opponents:0-2": of the other one; their keys. What is wrong goes to `problems`.
std::vector<int> parse_robot_keys(std::string_view text, const SessionSetup& setup,
                                  std::vector<std::string>& problems);

// "0-5", "0,2,7", "0-2,7" -> ascending ids, each once. What is wrong goes to `problems`, a line each.
std::vector<int> parse_robot_list(std::string_view text, std::vector<std::string>& problems);

}  // namespace omnihil
