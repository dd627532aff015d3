// Between a wire and the loop: the line's pace both ways, bounded queues, and what was lost by whom.
//
//   HostPort port(wire, carrier_pace(format.carrier), {});
//   port.receive(now_ns, host);                        // bytes that have reached the dongle by now
//   session.step(host, answer);
//   port.send(session.now_ns(), answer);
//   if (port.take_host_closed()) session.host_closed();
//
// Into the dongle. From the wire no more is taken than the line's buffer holds, so a host that floods
// is held back by its own write(), as a real port would; nothing is lost. Unpaced, a step takes `bite_bytes`
// at most (4096 bytes per 1 ms step are 4 MB/s, more than USB full speed carries).
// Out of the dongle. What a host does not fetch waits in the kernel and then in a queue of `queue_bytes`.
// An answer (all bytes of one step) that no longer fits is dropped whole, the newest first: an unframed
// packet stream stays in step. Without a host, answers go nowhere, as from a dongle nobody has opened.
// A close reaches the loop after every byte that came before it has.
#pragma once
#include <cstdint>
#include <span>
#include <system_error>
#include <vector>

#include "hil/wire/pacer.h"
#include "hil/wire/send_queue.h"
#include "protocols/radio_format.h"

namespace omnihil {

// The pace of a format's carrier: the baud rate of a UART; USB CDC and UDP have none.
LinePace carrier_pace(const Carrier& carrier);

struct HostPortOptions {
  std::size_t bite_bytes = 4096;
  std::size_t queue_bytes = 65'536;
};

struct HostPortCounts {
  std::uint64_t bytes_from_host = 0;
  std::uint64_t bytes_to_host = 0;       // taken by the wire
  std::uint64_t answers_dropped = 0;     // queue full: the host does not read
  std::uint64_t bytes_dropped = 0;       // in those answers
  std::uint64_t bytes_left_behind = 0;   // the host closed before fetching them
  std::uint64_t bytes_without_host = 0;  // nobody had the port open
  std::uint64_t hosts = 0;               // how often a host came
};

class HostPort {
 public:
  HostPort(ByteWire& wire, const LinePace& pace, const HostPortOptions& options);

  // Replaces `host` with what reaches the dongle by now_ns. An error ends the run: the device is gone.
  std::error_code receive(std::int64_t now_ns, std::vector<std::uint8_t>& host);
  std::error_code send(std::int64_t now_ns, std::span<const std::uint8_t> answer);
  // True once per host that left, when all it wrote has been received.
  bool take_host_closed();
  bool host_present() const { return present_; }
  const HostPortCounts& counts() const { return counts_; }

 private:
  void look_who_is_there();
  std::error_code flush();

  ByteWire& wire_;
  HostPortOptions options_;
  Pacer inward_;
  Pacer outward_;
  std::vector<std::uint8_t> bite_;
  SendQueue ready_;  // crossed the line, not yet taken by the wire
  bool present_ = false;
  bool closing_ = false;  // the host left; what it wrote is still on the line
  HostPortCounts counts_;
};

}  // namespace omnihil
