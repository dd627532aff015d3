// What the differential test and its oracle tell each other over a pair of pipes: plain structures, batch by
// batch.
//
//   test   -> oracle: OracleBatch, then its OracleCases
//   oracle -> test:   as many OracleResults
//
// Every case starts from the same RAM, made from the batch's seed, and runs code at a place of its own in
// flash.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace omnihil::mcu {

inline constexpr std::uint32_t kOracleFlash = 0x08000000, kOracleFlashBytes = 1 << 20;
inline constexpr std::uint32_t kOracleRam = 0x20000000, kOracleRamBytes = 16 << 10;
inline constexpr std::uint32_t kOracleSlotBytes = 32;                // of code a case can have
inline constexpr std::uint32_t kOracleCode = kOracleFlash + 0x2000;  // no literal reaches below 0x1000

enum class OracleEnd : std::uint32_t { kRan, kUndefined, kMemory, kException };

struct OracleBatch {
  std::uint32_t cases;
  std::uint32_t slot;  // of the first case; the others follow
  std::uint64_t ram_seed;
};
struct OracleCase {
  std::uint32_t r[15];
  std::uint32_t apsr;
  std::uint32_t s[32];
  std::uint32_t fpscr;
  std::uint16_t code[kOracleSlotBytes / 2];
  std::uint32_t until;  // bytes of code to run through, with a jump to itself behind them; 0: one instruction
};
struct OracleResult {
  OracleEnd end;
  std::uint32_t r[16];
  std::uint32_t apsr;
  std::uint32_t s[32];
  std::uint32_t fpscr;
  std::uint64_t ram_hash;
};

using OracleRam = std::array<std::uint64_t, kOracleRamBytes / 8>;

// splitmix64 (Steele, Lea, Flood 2014): counter-based, so both sides make the same.
inline std::uint64_t oracle_mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
  x = (x ^ x >> 27) * 0x94D049BB133111EBu;
  return x ^ x >> 31;
}
inline void fill_oracle_ram(OracleRam& ram, std::uint64_t seed) {
  for (std::size_t i = 0; i < ram.size(); ++i) ram[i] = oracle_mix(seed + i);
}
inline std::uint64_t hash_oracle_ram(const OracleRam& ram) {
  std::uint64_t lane[4] = {1, 2, 3, 4};
  for (std::size_t i = 0; i < ram.size(); i += 4) {
    for (std::size_t k = 0; k < 4; ++k) lane[k] = (lane[k] ^ ram[i + k]) * 0xD6E8FEB86659FD93u;
  }
  return lane[0] ^ lane[1] >> 7 ^ lane[2] >> 13 ^ lane[3] >> 19;
}

}  // namespace omnihil::mcu
