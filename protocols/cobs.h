// Consistent Overhead Byte Stuffing: bytes without a zero, so that a zero can end the frame.
//
//   11 00 22 33  ->  02 11 03 22 33      (the delimiter 00 is not part of it)
//
// Each code byte n stands before n - 1 bytes other than zero and, unless n = FFh or the data ends there,
// for the zero after them. Source: Cheshire and Baker, IEEE/ACM Transactions on Networking 7(2), 1999.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace omnihil {

// The most bytes that n bytes of data become.
constexpr std::size_t cobs_max_size(std::size_t n) { return n + 1 + n / 254; }

// Appends the stuffed data to `out`, without the delimiter.
inline void cobs_encode(std::span<const std::uint8_t> data, std::vector<std::uint8_t>& out) {
  std::size_t code_at = out.size();
  std::uint8_t code = 1;
  out.push_back(0);
  for (std::size_t i = 0; i < data.size(); ++i) {
    if (data[i] != 0) {
      out.push_back(data[i]);
      ++code;
    }
    const bool block_full = code == 0xFF && i + 1 < data.size();
    if (data[i] == 0 || block_full) {
      out[code_at] = code;
      code_at = out.size();
      code = 1;
      out.push_back(0);
    }
  }
  out[code_at] = code;
}

enum class CobsStatus : std::uint8_t {
  kOk,
  kBadCode,  // a zero inside, or a code that points past the end
  kTooLong,  // more data than `out` holds
};

struct CobsResult {
  CobsStatus status = CobsStatus::kOk;
  std::size_t size = 0;  // bytes written to `out`
};

// Takes the stuffing out of `stuffed` (without the delimiter). Writes at most out.size() bytes.
constexpr CobsResult cobs_decode(std::span<const std::uint8_t> stuffed, std::span<std::uint8_t> out) {
  std::size_t written = 0;
  std::size_t at = 0;
  while (at < stuffed.size()) {
    const std::size_t code = stuffed[at];
    if (code == 0 || at + code > stuffed.size()) return {CobsStatus::kBadCode, written};
    for (std::size_t i = at + 1; i < at + code; ++i) {
      if (stuffed[i] == 0) return {CobsStatus::kBadCode, written};
      if (written == out.size()) return {CobsStatus::kTooLong, written};
      out[written++] = stuffed[i];
    }
    at += code;
    if (code != 0xFF && at < stuffed.size()) {
      if (written == out.size()) return {CobsStatus::kTooLong, written};
      out[written++] = 0;
    }
  }
  return {CobsStatus::kOk, written};
}

}  // namespace omnihil
