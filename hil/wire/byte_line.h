// A serial line to a board: bytes both ways, never blocking except in wait().
//
//   std::string problem;
//   auto line = open_byte_line("/dev/ttyACM0", {921600}, problem);      // nullptr: `problem` says why
//   line->write(frame);
//   line->wait(1'000'000);                                            // until bytes come, 1 ms at most
//   std::size_t n = line->read(buffer);
//
// Real ports go through libserialport (8 data bits, 1 stop bit, no flow control). It refuses
// pseudo-terminals, so these are opened by termios: emulated boards, socat relays.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace omnihil {

class ByteLine {
 public:
  virtual ~ByteLine() = default;
  virtual std::size_t read(std::span<std::uint8_t> out) = 0;
  // What the line cannot take now waits here and goes first next time; false: too much waits, dropped whole.
  virtual bool write(std::span<const std::uint8_t> bytes) = 0;
  virtual void wait(std::int64_t at_most_ns) = 0;
  virtual std::string_view failure() const = 0;  // why the device is gone; empty: it is not
};

struct SerialMode {
  int baud = 0;
  bool even_parity = false;
};

std::unique_ptr<ByteLine> open_byte_line(const std::string& device, const SerialMode& mode,
                                         std::string& problem);

}  // namespace omnihil
