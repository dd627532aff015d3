// The times of ULaval's air: nRF24L01+ at 1 Mb/s, 23-byte payload, acknowledged, one frame at a time.
// Sources: RobotMCU 44cc54f (BaseStation_stm32f4discovery: nrfDriver.c, communicationTask.c, hermes.h);
// nRF24L01+ product specification 1.0, 6.1.7 (timing) and 7.3 (packet format).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "protocols/hermes_types.h"

namespace omnihil::hermes {

inline constexpr std::size_t kPayloadBytes = 23;  // longest frame with its delimiter; shorter ones are padded

// Preamble 8, address 40, packet control 9, payload, CRC 8 bits; 1 us each.
constexpr std::int64_t air_time_ns(std::size_t payload_bytes) {
  return (8 + 40 + 9 + static_cast<std::int64_t>(payload_bytes) * 8 + 8) * 1'000;
}

inline constexpr std::int64_t kSettling_ns = 130'000;  // standby to transmit, or turning round
inline constexpr std::int64_t kFrame_ns =
    kSettling_ns + air_time_ns(kPayloadBytes);  // until the robot has it
inline constexpr std::int64_t kAck_ns = kSettling_ns + air_time_ns(0);
inline constexpr std::int64_t kNoAck_ns = 1'000'000;            // how long the radio waits for an ack
inline constexpr std::int64_t kAnswerTimeout_ns = 5'000'000;    // how long the dongle waits for an answer
inline constexpr std::int64_t kRobotTurnaround_ns = 1'000'000;  // request to answer in the robot; guess
// How often the dongle sends a request that gets no answer.
constexpr int tries(std::uint32_t type) { return type == kGetNumRequest ? 1 : 3; }
inline constexpr std::size_t kQueueFrames = 149;  // the dongle's ring of 150, one kept free

// The radio numbers its frames modulo 4 and a receiver takes an equal number for a repetition. The dongle
// works around that: a frame whose address was last used exactly four transmissions ago is sent twice.
class RepeatRule {
 public:
  bool sends_twice(int address) {
    const bool last_three = is(0, address) || is(1, address) || is(2, address);
    const bool twice = !last_three && is(3, address);
    note(address);
    if (twice) note(address);
    return twice;
  }

 private:
  bool is(std::size_t back, int address) const { return sent_[back] == address; }
  void note(int address) { sent_ = {address, sent_[0], sent_[1], sent_[2]}; }

  std::array<int, 4> sent_{-1, -1, -1, -1};  // latest first
};

}  // namespace omnihil::hermes
