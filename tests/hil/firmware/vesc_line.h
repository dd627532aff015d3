// What a VESC is told and says over its serial port, on whatever bench it runs.
//
//   VescLine line(*board, [&] { bench.period(); });
//   Bytes values = line.ask({kValues});     // runs the bench until the answer is there
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/board/board.h"
#include "firmware_iface/mcu/stm32/usart.h"

namespace omnihil::vesc {

using Bytes = std::vector<std::uint8_t>;

enum Packet : std::uint8_t {
  kVersion = 0,
  kValues = 4,
  kDuty = 5,
  kCurrent = 6,
  kSpeed = 8,
  kSetSettings = 13,
  kSettings = 14,
  kMeasureResistance = 25,
  kMeasureFlux = 57
};
inline constexpr unsigned kCanSpeed = 3;

inline void put_big(Bytes& bytes, std::int32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

inline Bytes floats(std::initializer_list<float> values) {
  Bytes bytes;
  for (const float value : values) put_big(bytes, std::bit_cast<std::int32_t>(value));
  return bytes;
}

inline std::int32_t get_big(const Bytes& bytes, std::size_t at, std::size_t count = 4) {
  if (at + count > bytes.size()) return 0;
  std::uint32_t value = bytes[at] >= 0x80 ? ~0u : 0u;
  for (std::size_t i = 0; i < count; ++i) value = value << 8u | bytes[at + i];
  return static_cast<std::int32_t>(value);
}

// CRC-16/XMODEM.
inline unsigned crc(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0;
  for (const unsigned byte : bytes) {
    sum ^= byte << 8u;
    for (int bit = 0; bit < 8; ++bit) sum = (sum << 1u ^ ((sum & 0x8000u) != 0 ? 0x1021u : 0u)) & 0xFFFFu;
  }
  return sum;
}

// 2 and a length of one byte, or 3 and of two; the payload; its sum; 3.
inline Bytes framed(const Bytes& payload) {
  const std::size_t size = payload.size();
  Bytes bytes = size < 255 ? Bytes{2} : Bytes{3, static_cast<std::uint8_t>(size >> 8u)};
  bytes.push_back(static_cast<std::uint8_t>(size));
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  const unsigned sum = crc(payload);
  for (const unsigned byte : {sum >> 8u, sum & 0xFFu, 3u}) bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

class VescLine {
 public:
  VescLine(const mcu::McuBoard& board, std::function<void()> step) : board_(board), step_(std::move(step)) {
    serial_ = board_.chip().find<mcu::Usart>("USART6");
    serial_->on_transmit([this](std::uint8_t byte, mcu::Cycles) { line_.push_back(byte); });
    // Its supply has to be still for two seconds before it takes its offsets, and its serial port opens then.
    for (int i = 0; i < 20 && ask({kVersion}, 0.5).empty(); ++i) continue;
  }
  VescLine(const VescLine&) = delete;

  void say(const Bytes& payload) { serial_->feed(framed(payload), board_.now_ns()); }
  // The payload of the next answer of this kind; what else comes is passed over. Empty: none in time.
  Bytes hear(std::uint8_t kind, double patience_s) {
    const std::int64_t end_ns = board_.now_ns() + std::llround(patience_s * 1e9);
    for (; board_.now_ns() < end_ns; step_()) {
      Bytes payload = next_packet();
      if (!payload.empty() && payload[0] == kind) return payload;
    }
    return {};
  }
  Bytes ask(const Bytes& payload, double patience_s = 1.0) {
    say(payload);
    return hear(payload[0], patience_s);
  }
  // For a motor without a sensor: its own settings, with these numbers instead of those that it was delivered with.
  void set_motor(double resistance_ohm, double inductance_H, double flux_linkage_Wb, float most_A) {
    Bytes settings = ask({kSettings});
    const auto change = [&settings](const Bytes& delivered, const Bytes& ours) {
      const auto at = std::search(settings.begin(), settings.end(), delivered.begin(), delivered.end());
      ASSERT_NE(at, settings.end()) << "another version: a setting is not as it was delivered";
      std::copy(ours.begin(), ours.end(), at);
    };
    const auto ohm = static_cast<float>(resistance_ohm), henry = static_cast<float>(inductance_H),
               weber = static_cast<float>(flux_linkage_Wb);
    change(floats({7e-6F, 0.0F, 0.015F, 0.00245F}), floats({henry, 0.0F, ohm, weber}));
    constexpr float kBandwidth_rad_s = 1000.0F;  // of the current loop: what its tool suggests
    change(floats({0.03F, 50.0F}), floats({kBandwidth_rad_s * henry, kBandwidth_rad_s * ohm}));
    change(floats({60.0F, -60.0F}), floats({most_A, -most_A}));
    settings[0] = kSetSettings;
    ASSERT_FALSE(ask(settings, 5.0).empty());
  }

 private:
  Bytes next_packet() {
    const std::size_t head = line_.empty() ? 0 : line_[0];
    if (line_.size() < 6 || line_.size() < head) return {};
    EXPECT_TRUE(head == 2 || head == 3);
    const std::size_t size = head == 2 ? line_[1] : line_[1] * 256u + line_[2];
    if (line_.size() < head + size + 3) return {};
    const auto begin = line_.begin() + static_cast<std::ptrdiff_t>(head);
    Bytes payload(begin, begin + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(line_[head + size] * 256u + line_[head + size + 1], crc(payload));
    line_.erase(line_.begin(), begin + static_cast<std::ptrdiff_t>(size + 3));
    return payload;
  }

  const mcu::McuBoard& board_;
  std::function<void()> step_;
  mcu::Usart* serial_ = nullptr;
  Bytes line_;
};

}  // namespace omnihil::vesc
