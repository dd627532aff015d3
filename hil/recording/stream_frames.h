// Cuts a byte stream into the frames of one radio format, for people and reports (not for the loop: the
// dongles have their own receivers). A frame is the shortest run of bytes that the format decodes; bytes
// that start no frame are given out in pieces that are marked as not understood.
//
//   FrameCutter cutter(*find_radio_format("roboteam-rem-v8"));
//   cutter.push(bytes);
//   while (auto frame = cutter.next()) …        // frame->understood, frame->bytes
//   cutter.finish(); while (auto rest = cutter.next()) …
//
// Limit: after damaged bytes it may find a frame inside them, with the format's checksum as the only guard.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "protocols/radio_format.h"

namespace omnihil {

class FrameCutter {
 public:
  struct Frame {
    std::uint64_t offset = 0;  // in the stream
    std::vector<std::uint8_t> bytes;
    bool understood = false;
  };

  explicit FrameCutter(const RadioFormat& format) : format_(format) {}

  void push(std::span<const std::uint8_t> bytes);
  // No more bytes will come: what waits for its end is given out as not understood.
  void finish() { finished_ = true; }
  std::optional<Frame> next();

 private:
  std::size_t frame_length() const;  // of the frame at the front; 0: none begins there (yet)
  Frame take(std::size_t count, bool understood);

  const RadioFormat& format_;
  std::vector<std::uint8_t> waiting_;
  std::size_t front_ = 0;  // of waiting_, the first byte not given out
  std::uint64_t offset_ = 0;
  bool finished_ = false;
};

}  // namespace omnihil
