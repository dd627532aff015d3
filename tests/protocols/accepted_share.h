// The share of random contents that a table lets pass, from its fields' kinds and limits.
//
//   const double share = contents_share(message);       // of free fields filled at random: within their limits
//   const double of_frames = frames_share(format, 10);  // of random frames of 10 bytes: packets of this format
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>

#include "protocols/radio_format.h"

namespace omnihil {

// Floats in the order of their values: as many lie between two as the difference of their ranks.
inline double float_rank(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto size = static_cast<double>(bits & 0x7FFFFFFFu);
  return bits >> 31 != 0 ? -size : size;
}

inline bool is_prescribed(FieldKind kind) {
  return kind == FieldKind::kConst || kind == FieldKind::kType || kind == FieldKind::kLength ||
         kind == FieldKind::kChecksum;
}

// Of the 2^bits contents of a field that a host chooses, those that are allowed.
inline double share_within_limits(const Field& field) {
  const bool limited = field.lo != field.hi;
  const double all = std::ldexp(1.0, field.bits);
  if (field.kind == FieldKind::kInteger && limited) {
    const double above = field.sign == Sign::kNone ? all : all / 2.0;
    const double largest = std::min(field.hi, above - 1.0);
    return std::max(0.0, std::floor(largest) - std::ceil(std::max(field.lo, above - all)) + 1.0) / all;
  }
  if (field.kind == FieldKind::kFloat32) {
    if (!limited) return 1.0 - 1.0 / 256.0;  // one exponent of 256 is that of NaN and the infinities
    return (float_rank(static_cast<float>(field.hi)) - float_rank(static_cast<float>(field.lo)) + 1.0) / all;
  }
  return 1.0;
}

inline double contents_share(const Message& message) {
  double share = 1.0;
  for (const Field& field : message.fields) {
    if (!is_prescribed(field.kind)) share *= share_within_limits(field);
  }
  return share;
}

// Of all packets (without framing) of this many bytes, those of this message: what is prescribed or computed
// has one content each.
inline double packets_share(const Message& message, std::size_t bytes) {
  const auto fields_bytes = static_cast<std::size_t>(message.size_bytes);
  if (message.text_tail ? bytes < fields_bytes : bytes != fields_bytes) return 0.0;
  double share = contents_share(message);
  for (const Field& field : message.fields) {
    if (field.kind == FieldKind::kLength && static_cast<double>(bytes) >= std::ldexp(1.0, field.bits))
      return 0.0;
    if (is_prescribed(field.kind)) share *= std::ldexp(1.0, -field.bits);
  }
  return share;
}

// Of all frames of this many bytes. Every packet has one frame (that its bytes come back is tested), so COBS
// with its one code (packets below 254 bytes) and its delimiter leaves one frame in 256^2.
inline double frames_share(const RadioFormat& format, std::size_t bytes) {
  std::size_t overhead = format.framing == Framing::kCobsZero ? 2 : 0;
  // Length, 0A, length of the packet have one content each; what is inside is always less likely than certain.
  if (format.framing == Framing::kProtobuf) return bytes < 3 ? 0.0 : std::ldexp(1.0, -24);
  if (format.list != nullptr) overhead = format.list->begin.size() + 2;  // begin, number, end
  if (bytes < overhead) return 0.0;
  double share = 0.0;
  for (const Message& message : format.messages) share += packets_share(message, bytes - overhead);
  return share * std::ldexp(1.0, -8 * static_cast<int>(overhead));
}

// How far a count of chances may lie from its mean: five standard deviations, and five where chances come one by
// one (Poisson: six where 0.1 are expected come once in 10^9). What is certain may not miss once.
inline double count_slack(double variance) { return variance == 0.0 ? 0.0 : 5.0 * std::sqrt(variance) + 5.0; }

}  // namespace omnihil
