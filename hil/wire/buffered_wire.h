// A byte wire with a queue for what it cannot take at once, and its first failure. For ends that may lose a
// message, but only a whole one: frames of a protocol.
//
//   BufferedWire wire(std::move(byte_wire), 4096);
//   wire.read(bytes, 1024);
//   if (!wire.write(answer)) ++dropped;            // too much waits: nothing of it is sent
//   if (wire.error()) std::cerr << wire.failure();   // "/dev/ttyACM0: Input/output error"
//
// With a queue of 0 bytes nothing waits: what the wire does not take of a message now is lost.
#pragma once
#include <memory>
#include <string>

#include "hil/wire/byte_wire.h"
#include "hil/wire/send_queue.h"

namespace omnihil {

class BufferedWire {
 public:
  BufferedWire(std::unique_ptr<ByteWire> wire, std::size_t queue_bytes)
      : wire_(std::move(wire)), queue_bytes_(queue_bytes) {}

  void read(std::vector<std::uint8_t>& out, std::size_t limit) { note(wire_->read(out, limit)); }
  bool write(std::span<const std::uint8_t> message);
  void flush();
  void clear() { queue_.clear(); }
  void wait(std::int64_t at_most_ns);  // until bytes come
  int handle() const { return wire_->handle(); }
  bool peer_present() const { return wire_->peer_present(); }
  bool take_peer_closed() { return wire_->take_peer_closed(); }

  std::string_view name() const { return wire_->name(); }
  std::error_code error() const { return error_; }
  std::string_view failure() const { return failure_; }  // empty: the wire is there

 private:
  void note(std::error_code error);

  std::unique_ptr<ByteWire> wire_;
  std::size_t queue_bytes_;
  SendQueue queue_;
  std::error_code error_;
  std::string failure_;
};

}  // namespace omnihil
