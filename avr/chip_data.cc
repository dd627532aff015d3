// The chip's data memory, seen from outside: registers and RAM.
#include <algorithm>

#include "avr/chip.h"

namespace omnihil_avr {

std::uint32_t Chip::data_bytes() const { return std::uint32_t{avr_->ramend} + 1; }
std::uint32_t Chip::ram_begin() const { return std::uint32_t{avr_->ioend} + 1; }

bool Chip::read_data(std::uint32_t address, std::span<std::uint8_t> out) const {
  if (address > data_bytes() || out.size() > data_bytes() - address) return false;
  std::copy_n(avr_->data + address, out.size(), out.begin());
  return true;
}

bool Chip::write_data(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  if (address < ram_begin() || address > data_bytes() || bytes.size() > data_bytes() - address) return false;
  std::copy(bytes.begin(), bytes.end(), avr_->data + address);
  return true;
}

}  // namespace omnihil_avr
