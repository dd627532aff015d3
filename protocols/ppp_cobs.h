// Byte stuffing that shortens zeros ("PPP-COBS"): bytes without a zero, so that a zero can end the packet.
//
//   05 00 00 00 00 00 00 45  ->  E1 05  D4  02 45        (the delimiter 00 is not part of it)
//
//   01 to D1   n - 1 bytes other than zero, and the zero after them
//   D2         209 bytes other than zero, and no zero
//   D3 to DF   n - D0h zeros
//   E0 to FF   n - E0h bytes other than zero, and the two zeros after them
//
// The data are taken with one zero more at their end, which the decoder takes away. Layout read in TIGERs
// Mannheim's firmware 1e48326.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace omnihil {

// Appends the stuffed data, without the delimiter.
inline void ppp_cobs_encode(std::span<const std::uint8_t> data, std::vector<std::uint8_t>& out) {
  constexpr std::size_t kMostBytes = 209, kMostBeforeTwoZeros = 31, kMostZeros = 15;
  const std::size_t end = data.size() + 1;
  const auto is_zero = [&](std::size_t i) { return i >= data.size() || data[i] == 0; };
  for (std::size_t at = 0; at < end;) {
    std::size_t bytes = 0;
    while (at + bytes < end && bytes < kMostBytes && !is_zero(at + bytes)) ++bytes;
    std::size_t zeros = 0;
    while (at + bytes + zeros < end && zeros < kMostZeros && is_zero(at + bytes + zeros)) ++zeros;
    if (bytes == 0 && zeros >= 3) {
      out.push_back(static_cast<std::uint8_t>(0xD0 + zeros));
    } else if (bytes == kMostBytes) {
      zeros = 0;
      out.push_back(0xD2);
    } else if (zeros >= 2 && bytes <= kMostBeforeTwoZeros) {
      zeros = 2;
      out.push_back(static_cast<std::uint8_t>(0xE0 + bytes));
    } else {
      zeros = 1;
      out.push_back(static_cast<std::uint8_t>(bytes + 1));
    }
    for (std::size_t i = 0; i < bytes; ++i) out.push_back(data[at + i]);
    at += bytes + zeros;
  }
}

// The data behind stuffed bytes without their delimiter; none where the codes do not fit.
inline std::optional<std::vector<std::uint8_t>> ppp_cobs_decode(std::span<const std::uint8_t> stuffed) {
  std::vector<std::uint8_t> data;
  for (std::size_t at = 0; at < stuffed.size();) {
    const std::size_t code = stuffed[at++];
    std::size_t bytes = 0, zeros = 0;
    if (code == 0) return std::nullopt;
    if (code <= 0xD1) {
      bytes = code - 1, zeros = 1;
    } else if (code == 0xD2) {
      bytes = 209;
    } else if (code <= 0xDF) {
      zeros = code - 0xD0;
    } else {
      bytes = code - 0xE0, zeros = 2;
    }
    if (at + bytes > stuffed.size()) return std::nullopt;
    const auto from = stuffed.subspan(at, bytes);
    if (std::find(from.begin(), from.end(), 0) != from.end()) return std::nullopt;
    data.insert(data.end(), from.begin(), from.end());
    data.insert(data.end(), zeros, 0);
    at += bytes;
  }
  if (data.empty() || data.back() != 0) return std::nullopt;
  data.pop_back();
  return data;
}

}  // namespace omnihil
