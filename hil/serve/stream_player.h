// Plays a host's stream into a byte wire at its own times, and counts what comes back: an AI host
// without the AI.
//
//   PlayOptions options{.speed = 1.0};
//   PlaySummary summary = play_stream(stream, *wire, options, stop);
//
// Times are wall-clock times of this computer; a write that the device does not take at once is kept and
// written as soon as it does. `stop` ends it early from a signal handler.
#pragma once
#include <csignal>
#include <map>
#include <string>
#include <system_error>

#include "hil/recording/stream_file.h"
#include "hil/wire/byte_wire.h"
#include "protocols/radio_format.h"

namespace omnihil {

struct PlayOptions {
  double speed = 1.0;                   // 2: twice as fast
  bool loop = false;                    // again from the start, until stopped
  double linger_s = 0.5;                // listen that long after the last write
  const RadioFormat* format = nullptr;  // decodes what comes back; null: bytes are counted only
};

struct PlaySummary {
  std::uint64_t writes = 0;
  std::uint64_t bytes_written = 0;
  std::uint64_t rounds = 0;  // times the whole stream was written
  std::uint64_t bytes_read = 0;
  std::map<std::string, std::uint64_t> packets;  // by message name
  std::uint64_t bytes_not_understood = 0;
  double wall_s = 0.0;
  double latest_s = 0.0;  // the most that a write began after its time
  bool stopped = false;   // early, by `stop`
  std::error_code error;  // the device went away

  std::string text() const;  // several lines for a person
};

PlaySummary play_stream(const HostStream& stream, ByteWire& wire, const PlayOptions& options,
                        const volatile std::sig_atomic_t& stop);

}  // namespace omnihil
