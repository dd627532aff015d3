#include "firmware_iface/mcu/stm32/math/crc.h"

#include <algorithm>
#include <bit>

namespace omnihil::mcu {
namespace {
enum : std::uint16_t { kData = 0x00, kControlOfCrc = 0x08, kStart = 0x10, kPolynomial = 0x14 };
constexpr std::uint32_t kEthernet = 0x04C11DB7, kOnes = 0xFFFFFFFF;

constexpr RegisterInfo kCrcV1[] = {{kData, "DR", kOnes}, {0x04, "IDR", 0, 0xFF}, {kControlOfCrc, "CR", 0, 0}};
constexpr RegisterInfo kCrcV2[] = {{kData, "DR", kOnes},
                                   {0x04, "IDR", 0},
                                   {kControlOfCrc, "CR", 0, 0xF8},
                                   {kStart, "INIT", kOnes},
                                   {kPolynomial, "POL", kEthernet}};
constexpr RegisterInfo kCrcFixed[] = {
    {kData, "DR", kOnes}, {0x04, "IDR", 0, 0xFF}, {kControlOfCrc, "CR", 0, 0xE0}, {kStart, "INIT", kOnes}};

std::span<const RegisterInfo> rows_of(CrcFamily family) {
  if (family == CrcFamily::kV1) return kCrcV1;
  return family == CrcFamily::kV2 ? std::span<const RegisterInfo>(kCrcV2) : kCrcFixed;
}

std::uint32_t turned(std::uint32_t data, unsigned bits) {
  std::uint32_t out = 0;
  for (unsigned i = 0; i < bits; ++i) out |= (data >> i & 1u) << (bits - 1 - i);
  return out;
}
}  // namespace

Crc::Crc(CrcFamily family, System& system) : RegisterBlock("CRC", system, rows_of(family)), family_(family) {}

void Crc::reset() { RegisterBlock::reset(); }

unsigned Crc::size_bits() const {
  constexpr unsigned kSizes[] = {32, 16, 8, 7};
  return family_ == CrcFamily::kV2 ? kSizes[field(value(kControlOfCrc), 3, 2)] : 32;
}

void Crc::start() { value(kData) = family_ == CrcFamily::kV1 ? kOnes : value(kStart); }

void Crc::take(std::uint32_t data, unsigned bits) {
  const unsigned size = size_bits();
  const std::uint32_t mask = kOnes >> (32 - size),
                      polynomial = family_ == CrcFamily::kV2 ? value(kPolynomial) : kEthernet;
  std::uint32_t crc = value(kData) & mask;
  for (unsigned i = bits; i-- > 0;) {
    const bool out = bit(crc, size - 1) != bit(data, i);
    crc = (crc << 1 ^ (out ? polynomial : 0u)) & mask;
  }
  value(kData) = crc;
}

std::uint32_t Crc::load(std::uint32_t offset) {
  const std::uint32_t word = value(offset);
  const bool turn = offset == kData && family_ != CrcFamily::kV1 && bit(value(kControlOfCrc), 7);
  return turn ? turned(word, size_bits()) : word;
}

void Crc::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == kControlOfCrc) {
    keep(offset, written, lanes);
    if (bit(written, 0)) start();
    return;
  }
  if (offset != kData) {
    keep(offset, written, lanes);
    if (offset == kStart) start();
    return;
  }
  if (family_ == CrcFamily::kV1) return take(written, 32);
  const unsigned shift = static_cast<unsigned>(std::countr_zero(lanes)),
                 bits = static_cast<unsigned>(std::popcount(lanes));
  std::uint32_t data = written >> shift;
  const unsigned unit = std::min(bits, 4u << field(value(kControlOfCrc), 5, 2));  // 8, 16 or 32 bits
  if (unit >= 8) {
    std::uint32_t turned_data = 0;
    for (unsigned at = 0; at < bits; at += unit) turned_data |= turned(data >> at, unit) << at;
    data = turned_data;
  }
  take(data, bits);
}

}  // namespace omnihil::mcu
