// Bytes that a wire could not take yet, in order.
//
//   queue.append(bytes);
//   const std::size_t sent = queue.flush(wire, error);     // as many as fit now
#pragma once
#include <cstdint>
#include <span>
#include <system_error>
#include <vector>

#include "hil/wire/byte_wire.h"

namespace omnihil {

class SendQueue {
 public:
  SendQueue() = default;
  // So that up to `bytes` can wait without a further allocation.
  explicit SendQueue(std::size_t bytes) : half_(bytes / 2) { bytes_.reserve(bytes + half_); }

  void append(std::span<const std::uint8_t> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  std::vector<std::uint8_t>& tail() { return bytes_; }  // to be appended to
  std::size_t waiting() const { return bytes_.size() - from_; }
  std::size_t flush(ByteWire& wire, std::error_code& error) {
    error.clear();
    if (waiting() == 0) return 0;
    const std::size_t sent = wire.write(std::span(bytes_).subspan(from_), error);
    from_ += sent;
    if (waiting() == 0 || from_ >= half_) {
      bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(from_));
      from_ = 0;
    }
    return sent;
  }
  void clear() {
    bytes_.clear();
    from_ = 0;
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t from_ = 0;  // what stands before has been sent
  std::size_t half_ = 0;  // sent bytes that are kept before they are moved away
};

}  // namespace omnihil
