// Between an AI host and its real dongle: every byte passes both ways, unchanged and in order, and is recorded on the way.
//
//   Tap tap(std::move(host_wire), std::move(dongle_wire), recorder, 1'000'000);
//   while (tap.pass(now_ns)) wait_for(tap.host_handle(), 1'000'000, false);       // or as tap_loop.h does
//   tap.counts().to_dongle, tap.problem();
//
// What the far end does not take at once waits in a queue, in its order: a host is stopped by its own full port only when
// 64 kB wait. Bytes of a dongle for which no host is there are recorded and dropped, as a serial line drops them.
// Times of the recording: a host's bytes at the next loop step, as `import` has them; a dongle's when they were read, but
// not before what came earlier.
// Pure but for its wires: the caller has the clock. Cannot: line settings of the host's side, which a pty does not tell.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hil/loop/session.h"
#include "hil/wire/byte_wire.h"
#include "hil/wire/descriptor.h"

namespace omnihil {

struct TapCounts {
  std::uint64_t to_dongle = 0, to_host = 0;  // bytes passed on
  std::uint64_t without_host = 0;            // bytes of the dongle that nobody was there for
  std::uint64_t host_left = 0;               // times
  std::uint64_t most_waiting = 0;            // bytes, in either queue
};

class Tap {
 public:
  static constexpr std::size_t kMostWaiting = 65536;  // bytes: a second of a line at 576 kbaud

  // `recorder`: not owned; null: none. step_ns: of the recording's loop.
  Tap(std::unique_ptr<ByteWire> host, std::unique_ptr<ByteWire> dongle, SessionObserver* recorder,
      std::int64_t step_ns);

  // Takes what has arrived and hands it on. now_ns: since the recording began, never back. False: the dongle, or the
  // host's port, is gone for good; problem() says which and why.
  bool pass(std::int64_t now_ns);

  int host_handle() const { return host_.wire->handle(); }
  int dongle_handle() const { return dongle_.wire->handle(); }
  const TapCounts& counts() const { return counts_; }
  const std::string& problem() const { return problem_; }
  // Whether the last pass() moved anything.
  bool moved() const { return moved_; }

 private:
  struct End {
    std::unique_ptr<ByteWire> wire;
    std::vector<std::uint8_t> waiting;  // to be written to it
  };
  bool take(End& from, End& to, std::int64_t now_ns, bool from_host);
  bool give(End& to, std::uint64_t& passed);
  bool lost(const End& end, const std::error_code& error);

  End host_, dongle_;
  SessionObserver* recorder_;
  std::int64_t next_step_ns(std::int64_t now_ns) const {
    return (now_ns + step_ns_ - 1) / step_ns_ * step_ns_;
  }

  std::int64_t step_ns_;
  std::int64_t recorded_ns_ = 0;  // last time in the recording, which never goes back
  std::vector<std::uint8_t> read_;
  TapCounts counts_;
  std::string problem_;
  bool moved_ = false;
};

}  // namespace omnihil
