// The times and sizes of RoboTeam's air: one slot per robot id, packets stitched together, SX1280 in FLRC.
// Sources: Basestation 0bb0bf9 (timer, stitching), microcontroller6.0 5bfe578 (answer), SX1280 data sheet,
// FLRC packet format. docs/dongles.md says what is known and what is our choice.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace omnihil::rem {

inline constexpr int kIds = 16;                       // ids the timer walks
inline constexpr std::int64_t kSlotsPerSecond = 960;  // 16 ids at 60 Hz each
inline constexpr std::size_t kAirBytes = 127;         // longest FLRC payload
inline constexpr std::size_t kQueue = 40;             // packets waiting per robot besides the command
inline constexpr std::int64_t kTurnaround_ns =
    100'000;  // robot: from packet received to answer on the air; guess
inline constexpr std::int64_t kAnswerWindow_ns = 1'000'000;  // the robot's window to answer in

// Slot k begins at k / 960 s and belongs to id k mod 16.
constexpr std::int64_t slot_start_ns(std::int64_t k) {
  return k / kSlotsPerSecond * 1'000'000'000 + k % kSlotsPerSecond * 1'000'000'000 / kSlotsPerSecond;
}

// FLRC at 1.3 Mb/s, code rate 3/4: 24 bits preamble and 32 bits sync word plain; then payload, 16 bits CRC
// and 6 bits tail, each three bits sent as four.
constexpr std::int64_t air_time_ns(std::size_t payload_bytes) {
  const auto coded = static_cast<std::int64_t>((payload_bytes * 8 + 16 + 6) * 4 + 2) / 3;
  return (24 + 32 + coded) * 10'000 / 13;
}

// Several packets stitched together, on their way to one robot.
struct AirPacket {
  int robot = 0;
  std::int64_t arrives_ns = 0;
  std::array<std::uint8_t, kAirBytes> bytes{};
  std::size_t size = 0;

  std::size_t room() const { return kAirBytes - size; }
  std::span<const std::uint8_t> span() const { return std::span(bytes).first(size); }
  void append(std::span<const std::uint8_t> packet) {
    std::copy(packet.begin(), packet.end(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    size += packet.size();
  }
};

}  // namespace omnihil::rem
