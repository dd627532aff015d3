// Checksums of frames, on the air and on wires.
//
//   const std::uint8_t frame[] = {0x01, 0xFE, 0x03};
//   std::uint8_t sum = sum8(frame);       // 02h: 258 mod 256
//   std::uint32_t crc = crc32(frame);     // that of zlib
//
// sum8 and xor8 see every change of one byte; of changes to several bytes one in 256 passes, and they do not see
// two bytes swapped. A CRC of n bits sees every run of wrong bits up to n long; of others one in 2^n passes.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace omnihil {

// Sum of all bytes modulo 256.
constexpr std::uint8_t sum8(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0;
  for (std::uint8_t byte : bytes) sum += byte;
  return static_cast<std::uint8_t>(sum & 0xFFu);
}

// Exclusive or of all bytes.
constexpr std::uint8_t xor8(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0;
  for (std::uint8_t byte : bytes) sum ^= byte;
  return static_cast<std::uint8_t>(sum);
}

// A CRC by the words of the usual catalogue: width up to 32 bits, polynomial without its highest bit, start,
// bits of each byte and of the result reflected or not, exclusive or at the end.
struct Crc {
  int bits;
  std::uint32_t polynomial;
  std::uint32_t start;
  bool reflected;
  std::uint32_t xor_out;

  constexpr std::uint32_t operator()(std::span<const std::uint8_t> bytes) const {
    const std::uint32_t top = 1u << (bits - 1);
    const std::uint32_t all = top | (top - 1u);
    std::uint32_t rest = start;
    for (const std::uint8_t byte : bytes) {
      for (int i = 0; i < 8; ++i) {
        const std::uint32_t bit = (byte >> (reflected ? i : 7 - i)) & 1u;
        const bool out = ((rest >> (bits - 1)) & 1u) != bit;
        rest = (rest << 1) & all;
        if (out) rest ^= polynomial;
      }
    }
    return (reflected ? mirrored(rest) : rest) ^ xor_out;
  }

 private:
  constexpr std::uint32_t mirrored(std::uint32_t value) const {
    std::uint32_t out = 0;
    for (int i = 0; i < bits; ++i) out |= ((value >> i) & 1u) << (bits - 1 - i);
    return out;
  }
};

inline constexpr Crc crc32{32, 0x04C11DB7u, 0xFFFFFFFFu, true, 0xFFFFFFFFu};  // CRC-32/ISO-HDLC: zlib
inline constexpr Crc crc16_xmodem{16, 0x1021u, 0, false, 0};                  // CRC-16/XMODEM
inline constexpr Crc crc8_maxim{8, 0x31u, 0, true, 0};                        // CRC-8/MAXIM-DOW, 1-Wire
inline constexpr Crc crc8_autosar{8, 0x2Fu, 0xFFu, false, 0xFFu};             // CRC-8/AUTOSAR

// A sum or CRC by the name that a table in a file gives it.
struct ChecksumKind {
  std::string_view name;   // "crc32"
  std::string_view title;  // "CRC-32/ISO-HDLC (that of zlib)"
  int bits = 0;
  std::uint64_t (*of)(std::span<const std::uint8_t> bytes) = nullptr;
};
using ChecksumBytes = std::span<const std::uint8_t>;
inline constexpr ChecksumKind kSum8{"sum8", "sum, modulo 256,", 8,
                                    [](ChecksumBytes b) -> std::uint64_t { return sum8(b); }};
inline constexpr ChecksumKind kXor8{"xor8", "exclusive or", 8,
                                    [](ChecksumBytes b) -> std::uint64_t { return xor8(b); }};
inline constexpr ChecksumKind kCrc8Maxim{"crc8-maxim", "CRC-8/MAXIM-DOW", 8,
                                         [](ChecksumBytes b) -> std::uint64_t { return crc8_maxim(b); }};
inline constexpr ChecksumKind kCrc8Autosar{"crc8-autosar", "CRC-8/AUTOSAR", 8,
                                           [](ChecksumBytes b) -> std::uint64_t { return crc8_autosar(b); }};
inline constexpr ChecksumKind kCrc16Xmodem{"crc16-xmodem", "CRC-16/XMODEM", 16,
                                           [](ChecksumBytes b) -> std::uint64_t { return crc16_xmodem(b); }};
inline constexpr ChecksumKind kCrc32{"crc32", "CRC-32/ISO-HDLC (that of zlib)", 32,
                                     [](ChecksumBytes b) -> std::uint64_t { return crc32(b); }};
inline constexpr const ChecksumKind* kChecksumKinds[] = {&kSum8,        &kXor8,        &kCrc8Maxim,
                                                         &kCrc8Autosar, &kCrc16Xmodem, &kCrc32};

}  // namespace omnihil
