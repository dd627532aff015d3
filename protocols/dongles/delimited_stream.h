// Cuts the bytes a host writes to a dongle into frames that end in 00.
//
//   DelimitedStream stream(23, counts);
//   stream.feed(bytes, [&](std::span<const std::uint8_t> frame) { … });   // frame with its delimiter
//
// Two delimiters in a row enclose nothing: no frame, and not an error (hosts send one to clear the line).
// More bytes without a delimiter than the longest frame has: one framing error, all dropped up to the next 00.
#pragma once
#include <array>
#include <cassert>
#include <cstdint>
#include <span>

#include "protocols/packet_error.h"

namespace omnihil {

class DelimitedStream {
 public:
  DelimitedStream(std::size_t longest_frame, PacketCounts& counts)
      : longest_(longest_frame), counts_(counts) {
    assert(longest_ <= buffer_.size());
  }

  template <class OnFrame>
  void feed(std::span<const std::uint8_t> bytes, OnFrame&& on_frame) {
    for (const std::uint8_t byte : bytes) {
      if (skipping_) {
        skipping_ = byte != 0;
      } else if (byte == 0 && fill_ == 0) {
        continue;
      } else if (fill_ == longest_) {
        overlong(byte);
      } else {
        buffer_[fill_++] = byte;
        if (byte != 0) continue;
        on_frame(std::span<const std::uint8_t>(buffer_).first(fill_));
        fill_ = 0;
      }
    }
  }

  // The host is gone: a half frame is dropped and counted.
  void close() {
    if (fill_ > 0) counts_.count(PacketError::kTooShort);
    fill_ = 0;
    skipping_ = false;
  }

 private:
  void overlong(std::uint8_t byte) {
    counts_.count(PacketError::kFraming);
    fill_ = 0;
    skipping_ = byte != 0;
  }

  std::size_t longest_;
  PacketCounts& counts_;
  std::array<std::uint8_t, 256> buffer_{};
  std::size_t fill_ = 0;
  bool skipping_ = false;
};

}  // namespace omnihil
