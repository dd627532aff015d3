// Checksums of radio frames.
//
//   const std::uint8_t frame[] = {0x01, 0xFE, 0x03};
//   std::uint8_t sum = sum8(frame);       // 02h: 258 mod 256
//
// sum8 sees every change of one byte; of changes to several bytes one in 256 passes, and it does not see
// two bytes swapped.
#pragma once
#include <cstdint>
#include <span>

namespace omnihil {

// Sum of all bytes modulo 256.
constexpr std::uint8_t sum8(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0;
  for (std::uint8_t byte : bytes) sum += byte;
  return static_cast<std::uint8_t>(sum & 0xFFu);
}

}  // namespace omnihil
