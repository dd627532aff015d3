// What the tests of captures share: other tools, frames by their fields, and files that are cut or damaged.
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <random>
#include <string>

#include "hil/capture/captured.h"
#include "tests/hil/recording/fake_run.h"

namespace omnihil::peers {

struct Said {
  int exit_code = -1;
  std::string text;
};

inline Said run(const std::string& command) {
  Said said;
  std::FILE* pipe = ::popen(("export TZ=UTC LC_ALL=C.UTF-8; { " + command + "; } 2>&1").c_str(), "r");
  if (pipe == nullptr) return said;
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) said.text.append(buffer, n);
  const int status = ::pclose(pipe);
  said.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  return said;
}

inline bool is_installed(const std::string& program) { return run("command -v " + program).exit_code == 0; }
inline bool has_python_can() { return run("/usr/bin/python3 -c 'import can'").exit_code == 0; }
inline Said can_peer(const std::string& what, const std::filesystem::path& file) {
  return run("/usr/bin/python3 '" OMNIHIL_SOURCE_DIR "/tests/hil/capture/can_peer.py' " + what + " '" +
             file.string() + "'");
}

inline Captured can_frame(std::int64_t at_ns, std::uint32_t id, std::vector<std::uint8_t> bytes,
                          CaptureWay way = CaptureWay::kUnknown) {
  Captured frame;
  frame.at_ns = at_ns;
  frame.carrier = CaptureCarrier::kCan;
  frame.can_id = id;
  frame.way = way;
  frame.bytes = std::move(bytes);
  return frame;
}

inline std::vector<std::uint8_t> counting(int count, int from = 0) {
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(from + i));
  return bytes;
}

inline bool notes_say(const Capture& capture, const std::string& what) {
  for (const std::string& note : capture.notes)
    if (note.find(what) != std::string::npos) return true;
  return false;
}

// No truncation and none of 10^4 files with one to four bytes changed may do worse than BadCapture; whatever is read is in
// the order of its times. Returns how many were read.
template <class Read>
std::size_t survive_damage(const std::string& golden, unsigned seed, Read&& read) {
  std::size_t was_read = 0;
  const auto attempt = [&](const std::string& damaged) {
    try {
      const Capture capture = read(damaged);
      ++was_read;
      std::int64_t last_ns = 0;
      for (const Captured& each : capture.pieces) {
        EXPECT_GE(each.at_ns, last_ns);
        EXPECT_LE(each.bytes.size(), damaged.size());
        last_ns = each.at_ns;
      }
    } catch (const BadCapture& error) {
      EXPECT_NE(std::string(error.what()), "");
    }
  };
  for (std::size_t length = 0; length <= golden.size(); ++length) attempt(golden.substr(0, length));
  std::mt19937 random(seed);
  for (int i = 0; i < 10'000; ++i) {
    std::string damaged = golden;
    for (unsigned k = random() % 4 + 1; k > 0; --k)
      damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    attempt(damaged);
  }
  return was_read;
}

}  // namespace omnihil::peers
