// A run on disk, as text that can be searched, cut and replayed: format "omnihil-recording/1".
//
//   # {"format":"omnihil-recording/1","commit":…,"robot":…,"radio":…,"seed":…,…}   header, one JSON line
//   > TIME_NS HEX            bytes the host wrote, as fed to the loop at that virtual time
//   < TIME_NS HEX            bytes the dongle gave the host
//   ! TIME_NS closed         the host closed its port
//   c TIME_NS ID v1 v2 …     a command to a robot's firmware past the radio (command_values.h has the order)
//   p TIME_NS ID x y yaw     a robot was put down there: m, m, rad
//   v TIME_NS ID vx vy w     a robot was given these speeds: m/s, m/s, rad/s, field frame
//   a TIME_NS ID 0|1         a robot went away, or came back
//   b TIME_NS x y z vx vy vz wx wy wz    the ball was put there: m, m/s, rad/s; without numbers: it was taken away
//   m TIME_NS x y yaw vx vy w radius front height …    real robots among ours, nine numbers of each; none: they are gone
//   } TIME_NS HEX            bytes that the opponents' host wrote
//   w TIME_NS x y z vx vy vz    where the ball was, every 10 ms: for pictures
//   t TIME_NS ID BOARD PORT TEXT    a line that a robot's board said on a console; to the end of the line, may be empty
//   s TIME_NS ID v1 v2 …     one robot at one control tick; column names and units are in the header
//   # {"end":…}              counters, wall time; absent when the run was cut off
//
// `s` lines stand for every Nth control tick of each robot (header: sample_every); bytes are all there.
// Numbers are written with as many digits as give the same double back. Lines are flushed at least once
// per simulated second, so a killed run is readable up to there.
#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hil/loop/session.h"
#include "hil/text/hashed_file.h"

namespace omnihil {

// A model file that another one names, with its whole text.
struct ModelText {
  std::string name;
  std::string text;
};

// Robots that are not of the session's model.
struct OtherRobots {
  std::vector<int> keys;  // ids; opponents: kOpponentKey + id
  std::string robot_model, robot_model_text;
  std::vector<ModelText> included_models;
};

// Everything needed to run it again.
struct RecordingHeader {
  std::string commit;            // of the program that wrote it
  std::string robot_model;       // name as given
  std::string robot_model_text;  // the model file's whole text, so that a replay needs no other file
  std::string radio_format;
  std::string firmware;  // what it calls itself
  std::vector<HashedFile>
      firmware_files;  // the user's own: library, or image and board; none: this program's
  std::vector<int> robot_ids;
  Team team = Team::kBlue;
  PlantOptions plant;
  std::int64_t step_ns = 0;
  std::uint64_t epoch_ms = 0;
  std::uint64_t seed = 0;
  AirOptions air;                 // what the radio lost; drawn from the seed
  FieldSetup field;               // what was on the floor; absent: robots alone, as runs were before
  std::vector<int> opponent_ids;  // the other team's, of the same model and firmware; none: there was none
  std::string opponents_radio;    // of their dongle; empty: none
  std::vector<TimedFault> faults;
  std::string bench;    // what the bench file said with all its options; empty: there was none
  double spread = 0.0;  // of each robot's numbers, in tolerances of the model
  std::vector<OtherRobots> other_robots;   // robots of other models
  std::vector<std::uint8_t> from;          // the world at the start (Session, SessionConfig::from)
  std::string started;                     // ISO 8601 wall time, informative only
  std::vector<ModelText> included_models;  // further files that the model names: its motor
  int sample_every = 10;                   // of a robot's control ticks, every Nth is written
  std::vector<std::string> columns;  // of the `s` lines; the writer fills in sample_columns() and `watched`
  std::vector<std::string> units;
  std::vector<std::string>
      watched;  // variables of the firmware: columns "var:NAME"; read back as columns alone
};

// Of both teams: what stands as ID in its lines.
std::vector<int> robot_keys(const RecordingHeader& header);

struct RecordedChunk {
  enum class Kind : std::uint8_t {
    kHostBytes,
    kDongleBytes,
    kHostClosed,
    kSample,
    kCommand,
    kPlaced,
    kPushed,
    kPresent,
    kBallPlaced,
    kOpponentsBytes,
    kBallSeen,
    kMovers,
    kConsole
  } kind = Kind::kHostBytes;
  std::int64_t now_ns = 0;
  std::vector<std::uint8_t> bytes;  // kHostBytes, kDongleBytes
  int robot_id = 0;  // kSample, kCommand, kPlaced, kPushed, kPresent, kConsole; opponents: kOpponentKey + id
  std::vector<double> sample;  // the line's numbers; kSample: in the order of header.columns
  int board = 0;               // kConsole: of the robot
  std::string port{}, text{};  // kConsole
};

// What the writer of a complete run counted.
struct RecordingEnd {
  std::int64_t now_ns = 0;
  double wall_s = 0.0;
  std::vector<std::pair<std::string, std::uint64_t>> counters;  // "host packets good", "… refused: checksum"
};

struct Recording {
  RecordingHeader header;
  std::vector<RecordedChunk> chunks;
  std::int64_t end_ns = 0;
  bool complete = false;       // the end line is there
  RecordingEnd end;            // valid when complete
  bool last_line_cut = false;  // the file ends inside a line, which was left out
};

// Name and unit of each value of an `s` line, and how to take it from a sample.
struct SampleColumn {
  std::string name;
  std::string unit;
  double (*get)(const RobotSample&) = nullptr;
  bool is_angle = false;  // differences are taken modulo a turn
};
const std::vector<SampleColumn>& sample_columns();

}  // namespace omnihil
