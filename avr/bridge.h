// What a motor's bridge does, worked out from the registers that lead to it: a timer's compare output, a
// direction pin and an enable pin. Changes act when they are written.
//
// Law: duty of the pin = (OCR + 1) / (TOP + 1) in the fast PWM modes, OCR / TOP in the phase-correct ones
// (data sheet DS40002061B, 15.7 and 16.9), 1 minus that when inverted; a pin that is not the timer's has its
// port's level. Cannot: modes that are no PWM (such a motor coasts), the delay of a buffered OCR to the next
// period.
#pragma once
#include <cstdint>

extern "C" {
#include <simavr/sim_avr.h>
}

namespace omnihil_avr {

struct Pin {
  char port = 'A';
  unsigned bit = 0;
};

// Data addresses of a port: PIN, DDR, PORT follow each other.
struct PinAddress {
  std::uint16_t pin_register = 0;
  unsigned bit = 0;
  std::uint16_t ddr() const { return static_cast<std::uint16_t>(pin_register + 1); }
  std::uint16_t port() const { return static_cast<std::uint16_t>(pin_register + 2); }
};

struct BridgeWires {
  PinAddress pwm;
  unsigned bits = 8;  // of the timer: 8 or 16
  std::uint16_t tccra = 0, tccrb = 0;
  std::uint16_t ocr = 0;            // of this channel
  unsigned com_shift = 6;           // where the channel's two mode bits are in TCCRA
  std::uint16_t ocra = 0, icr = 0;  // what may be the top
  bool inverted = false;
  bool has_direction = false, forward_is_high = true;
  PinAddress direction;
  bool has_enable = false;
  PinAddress enable;
};

struct BridgeState {
  bool driven = false;      // else: coast
  double duty_ratio = 0.0;  // -1 to 1
};

BridgeState bridge_state(const BridgeWires& wires, const std::uint8_t* data);

}  // namespace omnihil_avr
