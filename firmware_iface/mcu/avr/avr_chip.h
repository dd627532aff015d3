// The AVR chips that a board file may name: their pins, PWM channels, serial ports and interrupts.
//
//   const AvrChip* chip = find_avr_chip("atmega328p");
//   chip->channel("OC1A")->tccra;         // 0x80, a data address
//
// The chip itself is emulated by a program of its own (avr/README.md); this is what the wiring needs.
// Numbers: data sheets DS40002061B (ATmega48A to 328P) and 7766J (ATmega16U4/32U4).
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "firmware_iface/mcu/board/board_spec.h"

namespace omnihil::mcu {

struct AvrChannel {  // a compare output; its registers' data addresses
  std::string_view name;
  PinName pin;
  unsigned bits = 8;
  std::uint16_t tccra = 0, tccrb = 0, ocr = 0, ocra = 0, icr = 0;
  unsigned com_shift = 6;  // of the channel's mode bits in TCCRnA
};

struct AvrInterrupt {
  std::string_view name;
  unsigned vector = 0;
};

struct AvrChip {
  std::string_view name;
  std::string_view ports;    // letters
  std::string_view serials;  // numbers, as letters
  unsigned adc_channels = 8;
  std::uint32_t flash_bytes = 0, eeprom_bytes = 0;
  std::vector<AvrChannel> channels;
  std::vector<AvrInterrupt> interrupts;

  const AvrChannel* channel(std::string_view channel_name) const;
  const AvrInterrupt* interrupt(std::string_view interrupt_name) const;
};

std::span<const AvrChip> all_avr_chips();
const AvrChip* find_avr_chip(std::string_view name);

}  // namespace omnihil::mcu
