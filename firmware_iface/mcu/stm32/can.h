// CAN between a chip and the outside: frames, their time on the wire, and the port that both controllers
// share.
//
//   can.on_transmit([](const CanFrame& frame, Cycles end) { … });   // when its last bit has left
//   can.receive(frame);                                             // its last bit has arrived, now
//   can_frame_bits(frame);                                          // 47 + 8 n + stuff bits, for classic frames
//
// Law: ISO 11898-1, bit stuffing counted exactly for classic frames (SOF .. CRC). CAN FD: stuffing of the
// arbitration phase is taken at its mean of one in ten; its data phase runs at the data rate where BRS is
// set. Cannot represent: arbitration against other nodes, errors, bus-off. Every frame is acknowledged; one
// that nobody was there for is counted.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/peripheral.h"
#include "firmware_iface/mcu/stm32/bus_ledger.h"

namespace omnihil::mcu {

struct CanFrame {
  std::uint32_t id = 0;
  bool extended = false, remote = false, fd = false, fast = false;  // fast: bit-rate switch
  std::uint8_t bytes = 0;                                           // of data: 0..8, FD also 12 .. 64
  std::array<std::uint8_t, 64> data{};
  bool operator==(const CanFrame&) const = default;
};

// Bits on the wire at the nominal rate, with the three of the interframe space.
unsigned can_frame_bits(const CanFrame& frame);
// These bits of a classic frame as they stand on the wire, true: recessive; the slot for the acknowledgement is dominant.
std::vector<bool> can_line_bits(const CanFrame& frame);
// Of these, FD only: bits at the data rate.
unsigned can_fast_bits(const CanFrame& frame);
unsigned can_dlc(unsigned bytes);
unsigned can_bytes(unsigned dlc, bool fd);

// What passed: sent by this end, or come from another.
struct CanPass {
  CanFrame frame;
  bool sent = false;
  double bit = 0.0;  // core cycles of one at the nominal rate
  Cycles end = 0;    // of the interframe space where sent, of the last bit where come
};

class CanPort : public BusEnd {
 public:
  void receive(const CanFrame& frame) {
    if (watcher_) watcher_({frame, false, bit_cycles(), present()});
    take(frame);
  }
  void on_transmit(std::function<void(const CanFrame&, Cycles end)> listener) {
    on_transmit_ = std::move(listener);
  }

  // For whoever draws the wire.
  void watch_frames(std::function<void(const CanPass&)> watcher) { watcher_ = std::move(watcher); }

 protected:
  virtual void take(const CanFrame& frame) = 0;
  virtual double bit_cycles() const = 0;
  virtual Cycles present() const = 0;
  void sent(const CanFrame& frame, Cycles end) {
    if (watcher_) watcher_({frame, true, bit_cycles(), end});
    if (on_transmit_) return on_transmit_(frame, end);
    ledger_.lost("frame", "sent, nobody is there to acknowledge (taken as acknowledged)", end);
  }
  void off_bus(Cycles at) { ledger_.lost("frame", "came while the controller was not on the bus", at); }
  void unwanted(Cycles at) { ledger_.lost("frame", "came that no filter takes", at); }
  void overflow(Cycles at) { ledger_.lost("frame", "came into a full FIFO", at); }

 private:
  std::function<void(const CanFrame&, Cycles)> on_transmit_;
  std::function<void(const CanPass&)> watcher_;
};

}  // namespace omnihil::mcu
