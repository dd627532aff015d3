// Cuts the bytes a host writes into frames whose beginning tells their length.
//
//   SizedStream stream(frame_bytes, counts);
//   stream.feed(bytes, [&](std::span<const std::uint8_t> frame) { … });
//
// frame_bytes(front): the length of the frame that `front` begins with; empty: more bytes are needed to tell;
// 0: no frame begins like this. Bytes that begin no frame are dropped one by one until one may begin: one
// framing error for each run of them.
#pragma once
#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "protocols/packet_error.h"

namespace omnihil {

using FrameBytes = std::function<std::optional<std::size_t>(std::span<const std::uint8_t> front)>;

class SizedStream {
 public:
  SizedStream(FrameBytes frame_bytes, PacketCounts& counts)
      : frame_bytes_(std::move(frame_bytes)), counts_(counts) {}

  template <class OnFrame>
  void feed(std::span<const std::uint8_t> bytes, OnFrame&& on_frame) {
    for (const std::uint8_t byte : bytes) {
      assert(fill_ < buffer_.size());  // no frame is longer
      buffer_[fill_++] = byte;
      while (const std::size_t size = whole_frame()) {
        on_frame(std::span<const std::uint8_t>(buffer_).first(size));
        drop(size);
      }
    }
  }

  // The host is gone, or silent for too long: a half frame is dropped and counted.
  void close() {
    if (fill_ > 0) counts_.count(PacketError::kTooShort);
    fill_ = 0;
    dropping_ = false;
  }

 private:
  void drop(std::size_t count) {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(count),
              buffer_.begin() + static_cast<std::ptrdiff_t>(fill_), buffer_.begin());
    fill_ -= count;
  }

  // Size of the frame at the front, once it is whole; 0: it is not yet.
  std::size_t whole_frame() {
    for (; fill_ > 0; drop(1)) {
      const std::optional<std::size_t> size =
          frame_bytes_(std::span<const std::uint8_t>(buffer_).first(fill_));
      if (size != std::size_t{0}) {
        const bool whole = size && *size <= fill_;
        if (whole) dropping_ = false;
        return whole ? *size : 0;
      }
      if (!dropping_) counts_.count(PacketError::kFraming);
      dropping_ = true;
    }
    return 0;
  }

  FrameBytes frame_bytes_;
  PacketCounts& counts_;
  std::array<std::uint8_t, 512> buffer_{};
  std::size_t fill_ = 0;
  bool dropping_ = false;
};

}  // namespace omnihil
