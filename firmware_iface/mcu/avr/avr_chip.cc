#include "firmware_iface/mcu/avr/avr_chip.h"

namespace omnihil::mcu {
namespace {

template <class Entry>
const Entry* find_by_name(const std::vector<Entry>& entries, std::string_view name) {
  for (const Entry& entry : entries) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

const std::vector<AvrChip>& chips() {
  static const std::vector<AvrChip> kChips = {
      {.name = "atmega328p",
       .ports = "BCD",
       .serials = "0",
       .flash_bytes = 32768,
       .eeprom_bytes = 1024,
       .channels = {{"OC0A", {'D', 6}, 8, 0x44, 0x45, 0x47, 0x47, 0, 6},
                    {"OC0B", {'D', 5}, 8, 0x44, 0x45, 0x48, 0x47, 0, 4},
                    {"OC1A", {'B', 1}, 16, 0x80, 0x81, 0x88, 0x88, 0x86, 6},
                    {"OC1B", {'B', 2}, 16, 0x80, 0x81, 0x8A, 0x88, 0x86, 4},
                    {"OC2A", {'B', 3}, 8, 0xB0, 0xB1, 0xB3, 0xB3, 0, 6},
                    {"OC2B", {'D', 3}, 8, 0xB0, 0xB1, 0xB4, 0xB3, 0, 4}},
       .interrupts = {{"TIMER2_COMPA", 7},
                      {"TIMER2_OVF", 9},
                      {"TIMER1_COMPA", 11},
                      {"TIMER1_OVF", 13},
                      {"TIMER0_COMPA", 14},
                      {"TIMER0_OVF", 16}}},
      {.name = "atmega32u4",
       .ports = "BCDEF",
       .serials = "1",
       .adc_channels = 14,
       .flash_bytes = 32768,
       .eeprom_bytes = 1024,
       .channels = {{"OC0A", {'B', 7}, 8, 0x44, 0x45, 0x47, 0x47, 0, 6},
                    {"OC0B", {'D', 0}, 8, 0x44, 0x45, 0x48, 0x47, 0, 4},
                    {"OC1A", {'B', 5}, 16, 0x80, 0x81, 0x88, 0x88, 0x86, 6},
                    {"OC1B", {'B', 6}, 16, 0x80, 0x81, 0x8A, 0x88, 0x86, 4},
                    {"OC3A", {'C', 6}, 16, 0x90, 0x91, 0x98, 0x98, 0x96, 6}},
       .interrupts = {{"TIMER1_COMPA", 17},
                      {"TIMER1_OVF", 20},
                      {"TIMER0_COMPA", 21},
                      {"TIMER0_OVF", 23},
                      {"TIMER3_COMPA", 32},
                      {"TIMER3_OVF", 35}}},
  };
  return kChips;
}

}  // namespace

const AvrChannel* AvrChip::channel(std::string_view channel_name) const {
  return find_by_name(channels, channel_name);
}
const AvrInterrupt* AvrChip::interrupt(std::string_view interrupt_name) const {
  return find_by_name(interrupts, interrupt_name);
}
std::span<const AvrChip> all_avr_chips() { return chips(); }
const AvrChip* find_avr_chip(std::string_view name) { return find_by_name(chips(), name); }

}  // namespace omnihil::mcu
