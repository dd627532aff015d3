// A serial port as its other end sees it, whatever registers it has.
//
//   port.on_transmit([](std::uint8_t byte, Cycles end) { … });    // when its stop bit has left
//   port.feed(bytes, at_ns);                         // from the other end, one frame after the other
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include "firmware_iface/mcu/stm32/bus_ledger.h"

namespace omnihil::mcu {

// What passed on one of its lines: levels from the start bit on, the first of them in bit 0.
struct SerialFrame {
  bool sent = false;  // else received
  std::uint8_t byte = 0;
  std::uint32_t levels = 0;
  unsigned bits = 0;
  Cycles bit = 0, end = 0;  // of one bit, of the last one
};

class SerialPort : public BusEnd {
 public:
  void on_transmit(std::function<void(std::uint8_t byte, Cycles end)> listener) {
    on_transmit_ = std::move(listener);
  }
  // For whoever draws the lines: each frame at its end.
  void watch_frames(std::function<void(const SerialFrame&)> watcher) { watcher_ = std::move(watcher); }
  // `bit_ns` 0: what this end is set to.
  virtual void feed(std::span<const std::uint8_t> bytes, std::int64_t at_ns, double bit_ns = 0.0) = 0;
  virtual double baud() const = 0;

 protected:
  std::function<void(std::uint8_t, Cycles)> on_transmit_;
  std::function<void(const SerialFrame&)> watcher_;
};

}  // namespace omnihil::mcu
