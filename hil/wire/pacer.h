// A serial line's pace: bytes wait in a queue and come out one by one, no faster than the line carries them.
// Pure: time is an argument, in virtual nanoseconds; nothing is read from a clock.
//
//   Pacer line({.baud = 115200, .bits_per_byte = 10}, 4096);
//   line.push(bytes, now_ns);          // as many as fit; returns how many
//   line.pop(now_ns, out);             // what has crossed the line by now: 11520 bytes in each second
//
// Law: byte k of a busy period that began at t0 has crossed at t0 + (k + 1) * bits_per_byte / baud seconds
// (start, data, parity and stop bits). Integer arithmetic throughout, so no byte is gained or lost by
// rounding however long the line is busy. baud 0: no pace, what goes in comes out at once (USB CDC, where
// the rate a host sets has no meaning).
// It cannot represent gaps between bytes, flow control lines, or wrong bytes from a wrong baud rate.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace omnihil {

struct LinePace {
  std::int64_t baud = 0;  // bits per second; 0: not paced
  int bits_per_byte = 10;
};

class Pacer {
 public:
  Pacer(const LinePace& pace, std::size_t capacity_bytes);

  std::size_t room() const { return ring_.size() - count_; }
  std::size_t waiting() const { return count_; }
  // Takes bytes that reach this end of the line at now_ns; returns how many fitted.
  std::size_t push(std::span<const std::uint8_t> bytes, std::int64_t now_ns);
  // Appends what has arrived at the other end by now_ns.
  void pop(std::int64_t now_ns, std::vector<std::uint8_t>& out);
  void clear();

 private:
  std::int64_t crossed(std::int64_t busy_ns) const;

  LinePace pace_;
  std::vector<std::uint8_t> ring_;
  std::size_t head_ = 0;
  std::size_t count_ = 0;
  std::int64_t busy_since_ns_ = 0;
  std::int64_t sent_in_period_ = 0;  // bytes of this busy period that have come out
};

}  // namespace omnihil
