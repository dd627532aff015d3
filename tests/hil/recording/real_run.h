// A real session, recorded: two robots that are driven over the air of a radio format for a short while, by a
// host that also sends damage, half a packet, and closes its port in between.
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/host_firmware.h"
#include "hil/recording/recording_header.h"
#include "hil/recording/recording_memory.h"
#include "hil/recording/recording_reader.h"
#include "hil/recording/session_setup.h"
#include "hil/text/recording_text.h"
#include "protocols/radio_format.h"
#include "tests/hil/recording/fake_run.h"

namespace omnihil::real {

using Bytes = std::vector<std::uint8_t>;

struct Case {
  const char* radio;
  const char* robot;
  Physics physics;
};
// Without it a test's name would have the struct's bytes, padding and all.
inline void PrintTo(const Case& c, std::ostream* out) {
  *out << c.radio << ' ' << c.robot << ' ' << to_string(c.physics);
}

inline Bytes frame(const RadioFormat& format, const char* message,
                   const std::vector<std::pair<const char*, double>>& fields) {
  Values values;
  values.message = format.find(message);
  EXPECT_NE(values.message, nullptr) << message;
  for (const auto& [name, number] : fields) values.set(name, number);
  Bytes out;
  EXPECT_EQ(format.encode(values, out).error, PacketError::kNone) << message;
  return out;
}

inline SessionSetup setup(const Case& which, std::vector<int> ids = {0, 3}) {
  SessionSetup setup;
  const StoredModel stored =
      load_robot_model(std::string(OMNIHIL_SOURCE_DIR "/models/robots/") + which.robot + ".toml", {});
  for (const ModelProblem& problem : stored.problems) ADD_FAILURE() << problem.text();
  setup.model = stored.bundle;
  setup.radio_format = which.radio;
  setup.robot_ids = std::move(ids);
  setup.plant.physics = which.physics;
  return setup;
}

// What the host writes at millisecond n.
inline Bytes host_bytes(const RadioFormat& format, const std::vector<int>& ids, int n) {
  Bytes bytes;
  const auto add = [&bytes](const Bytes& more) { bytes.insert(bytes.end(), more.begin(), more.end()); };
  const bool is_hermes = format.id == "ulaval-hermes";
  for (const int id : ids) {
    const double robot = id;
    if (n % 20 == 0 && is_hermes) {
      add(frame(format, "SPEED_MOVE_ADVANCE", {{"robot", robot}, {"vx", 0.4}, {"vy", 0.1}, {"vtheta", 0.5}}));
      add(frame(format, "GET_BATTERIE", {{"robot", robot}}));
    }
    if (n % 20 == 0 && !is_hermes) {
      std::vector<std::pair<const char*, double>> fields{
          {"toRobotId", robot}, {"toColor", 1}, {"fromPC", 1}, {"rho", 0.4}};
      if (format.find("REM_RobotCommand")->field_index("sendStateInfo") >= 0)
        fields.push_back({"sendStateInfo", 1});
      add(frame(format, "REM_RobotCommand", fields));
    }
  }
  if (n == 33) add({0x11, 0x22, 0x00, 0x33});  // damage
  if (n == 55) add({0x03, 0x01});              // half a packet
  return bytes;
}

// `host`: what is written in each millisecond; without one host_bytes(), and a dongle that is closed once.
using HostAt = std::function<Bytes(int millisecond)>;
inline Recording record(const SessionSetup& setup, int milliseconds, int sample_every = 5,
                        const Session::FirmwareMaker& firmware = make_reference_firmware,
                        const HostAt& host = {}) {
  RecordingHeader header = recording_header(setup, "abc1234");
  header.sample_every = sample_every;
  Session session(session_config(setup), firmware);
  header.firmware = session.firmware(0).name();
  RecordingMemory memory(header);
  session.set_observer(&memory);
  const RadioFormat& format = *find_radio_format(setup.radio_format);
  Bytes out;
  for (int n = 0; n < milliseconds; ++n) {
    if (!host && n == 70) session.host_closed();
    session.step(host ? host(n) : host_bytes(format, setup.robot_ids, n), out);
  }
  return memory.take(session.now_ns());
}

inline std::string line_of(const RecordedChunk& chunk) {
  using Kind = RecordedChunk::Kind;
  std::string line(1, chunk.kind == Kind::kHostBytes     ? '>'
                      : chunk.kind == Kind::kDongleBytes ? '<'
                      : chunk.kind == Kind::kHostClosed  ? '!'
                                                         : 's');
  line += " " + std::to_string(chunk.now_ns);
  if (chunk.kind == Kind::kSample) line += " " + std::to_string(chunk.robot_id);
  if (chunk.kind == Kind::kHostClosed) line += " closed";
  if (!chunk.bytes.empty()) line += " " + to_hex(chunk.bytes);
  for (const double value : chunk.sample) append_number(line += ' ', value);
  return line + "\n";
}

// The recording as a file has it.
inline std::string text_of(const Recording& recording) {
  std::string text = "# " + to_json(recording.header) + "\n";
  for (const RecordedChunk& chunk : recording.chunks) text += line_of(chunk);
  return text + "# {\"end\":{\"now_ns\":" + std::to_string(recording.end_ns) +
         ",\"wall_s\":1,\"counters\":{}}}\n";
}

inline Recording from_text(const std::string& text) {
  std::istringstream stream(text);
  return load_recording(stream, "run.omnirec");
}

inline const Case kHermes{"ulaval-hermes", "ulaval_delta", Physics::kPlanar};
inline const Case kHermesSimbody{"ulaval-hermes", "ulaval_delta", Physics::kSimbody};
inline const Case kRem{"roboteam-rem-v8", "roboteam_2024", Physics::kPlanar};

}  // namespace omnihil::real
