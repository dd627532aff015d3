// A wire that carries bytes: a pseudo-terminal, a serial port, a socket. Never blocks.
//
//   wire.read(bytes, 4096);                                // what has arrived, in order
//   if (wire.take_peer_closed()) session.host_closed();    // after the last of those bytes
//   if (wire.peer_present()) wire.write(answer, error);
//
// Opened by URL: hil/wire/open_wire.h. What a wire cannot take at once waits in a queue: hil/wire/buffered_wire.h.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <system_error>
#include <vector>

namespace omnihil {

class ByteWire {
 public:
  virtual ~ByteWire() = default;
  virtual std::string_view name() const = 0;  // in messages: "pty:./dongle", "/dev/ttyACM0"
  // Appends what has arrived, at most `limit` bytes, so that a flood cannot stall the loop. An error: the
  // wire is gone.
  virtual std::error_code read(std::vector<std::uint8_t>& out, std::size_t limit) = 0;
  // Takes as many bytes as fit now; returns how many. The rest stays with the caller.
  virtual std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) = 0;
  // File descriptor that is readable when bytes wait, for wait_for() (hil/wire/descriptor.h); -1: none now.
  virtual int handle() const { return -1; }
  // Of wires that others open and leave, such as a pty that we offer. The rest cannot tell.
  virtual bool peer_present() const { return true; }
  // True once after each time the peer went away; everything it had written has been read before.
  virtual bool take_peer_closed() { return false; }
};

}  // namespace omnihil
