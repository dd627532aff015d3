// What an AI host wrote to its dongle, with the times: the input of `omnihil play`.
//
//   HostStream stream = load_stream("examples/streams/hermes-drive.txt", "");
//
// Three forms, told apart by how the file begins:
//   text       one line "TIME_S HEX" per write; '#' begins a comment; times do not decrease
//   JSON       {"sessions": {"NAME": [[SECONDS, "HEX"], …], …}, …}; a session is picked by name
//   recording  the `>` lines of an "omnihil-recording/1" file (its closes of the port are left out)
#pragma once
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "hil/recording/recording.h"

namespace omnihil {

struct StreamChunk {
  std::int64_t at_ns = 0;
  std::vector<std::uint8_t> bytes;
};

struct HostStream {
  std::string session;  // name of the session played, where the file has several
  std::vector<StreamChunk> chunks;

  std::int64_t duration_ns() const { return chunks.empty() ? 0 : chunks.back().at_ns; }
  std::uint64_t byte_count() const;
};

class BadStream : public std::runtime_error {
 public:
  explicit BadStream(const std::vector<std::string>& problems);
};

// `session` may be empty when the file has but one. Throws BadStream or BadRecording (all problems, with
// their places) or std::system_error.
HostStream load_stream(const std::filesystem::path& path, const std::string& session);
HostStream parse_stream(const std::string& text, const std::string& name, const std::string& session);

HostStream stream_of(const Recording& recording);
std::string to_text(const HostStream& stream, const std::string& comment);

}  // namespace omnihil
