// The first line of a recording: one JSON object that says everything needed to run it again.
//
//   {"format":"omnihil-recording/1","commit":"1a2b3c4","robot":"ulaval","robot_text":"…","radio":"ulaval-hermes",
//    "robot_ids":[0,1],"team":"blue","physics":"simbody","integrator":"rk4","seed":1,"columns":["true_x_m",…],…}
//
// Every key is required and no other is allowed, so that a header cannot be half understood. Exceptions:
// firmware_files, {"NAME":"SHA-256"}, what a user's own firmware came from; absent, this program's own ran; and air,
// {"share":0.02,…}, what the radio lost; absent, nothing; field, {"size":"division-b","ball":[0,0]}, that robots touch each
// other, and what else is on the floor; opponents, {"robot_ids":[0,1],"radio":"…"}, the other team; other_robots,
// [{"robot_ids":[3],"robot":…,"robot_text":…,"included_models":{…}}], robots of other models (ids of opponents: 32 + id);
// from, hex digits, the world that the run began with.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hil/recording/recording.h"

namespace omnihil {

inline constexpr std::string_view kRecordingFormat = "omnihil-recording/1";

// One line, without "# " and line end.
std::string to_json(const RecordingHeader& header);

// Appends one line per problem ("key 'team': found \"green\", allowed \"yellow\", \"blue\""); an empty
// result only when there is at least one.
std::optional<RecordingHeader> parse_recording_header(std::string_view json,
                                                      std::vector<std::string>& problems);

// Names as in the header and on the command line.
std::string_view to_string(Physics physics);        // "simbody", "simbody-free", "planar"
std::string_view to_string(Integrator integrator);  // "euler", "rk4"
std::optional<Physics> parse_physics(std::string_view name);

}  // namespace omnihil
