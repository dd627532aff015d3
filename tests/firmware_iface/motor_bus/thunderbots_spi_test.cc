// Thunderbots' SPI boards: bytes by the layout (the CRC by another way than the bus's own), sequences, the loop.
#include <gtest/gtest.h>

#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

// CRC-8/AUTOSAR by division: the message with 8 zeros, its first 8 bits inverted, modulo x^8 + 2Fh; inverted.
std::uint8_t autosar(const std::vector<std::uint8_t>& bytes) {
  std::vector<int> bits;
  for (const std::uint8_t byte : bytes) {
    for (int i = 7; i >= 0; --i) bits.push_back(byte >> i & 1);
  }
  for (std::size_t i = 0; i < 8; ++i) bits[i] ^= 1;
  bits.insert(bits.end(), 8, 0);
  constexpr int kDivisor[] = {1, 0, 0, 1, 0, 1, 1, 1, 1};
  for (std::size_t i = 0; i + 8 < bits.size(); ++i) {
    if (bits[i] == 0) continue;
    for (std::size_t k = 0; k < 9; ++k) bits[i + k] ^= kDivisor[k];
  }
  unsigned rest = 0;
  for (std::size_t i = bits.size() - 8; i < bits.size(); ++i)
    rest = rest << 1 | static_cast<unsigned>(bits[i]);
  return static_cast<std::uint8_t>(rest ^ 0xFF);
}

BusFrame transfer(std::uint32_t line, std::uint8_t sequence, std::uint8_t opcode,
                  const std::vector<std::uint8_t>& data) {
  std::vector<std::uint8_t> bytes{0xAA, 0xBB, 0xCC, sequence, opcode};
  bytes.insert(bytes.end(), data.begin(), data.end());
  bytes.resize(9);
  bytes.push_back(autosar(bytes));
  BusFrame f = can_frame(line, 10);
  std::copy(bytes.begin(), bytes.end(), f.data.begin());
  return f;
}
BusFrame speed(std::uint32_t line, std::uint8_t sequence, std::int16_t rpm, bool enabled = true) {
  return transfer(line, sequence, 1,
                  {static_cast<std::uint8_t>(enabled), static_cast<std::uint8_t>(rpm >> 8),
                   static_cast<std::uint8_t>(rpm)});
}
int word(const BusFrame& f, std::size_t at) {
  return static_cast<std::int16_t>(f.data[at] << 8 | f.data[at + 1]);
}
double rotor_rpm(const BusRig& rig, std::size_t wheel) { return 60.0 * rig.rotor_turns_s(wheel); }

TEST(ThunderbotsSpiTest, the_checksum_is_that_of_the_catalogue) {
  EXPECT_EQ(autosar({'1', '2', '3', '4', '5', '6', '7', '8', '9'}), 0xDF);
}

TEST(ThunderbotsSpiTest, a_commanded_speed_is_reached_in_the_plant_and_told) {
  BusRig rig("thunderbots-spi");
  std::uint8_t sequence = 0;
  rig.run_ms(1500, [&] {
    ++sequence;
    for (std::uint32_t m = 0; m < 4; ++m) rig.send(speed(m, sequence, 300));
  });
  for (std::size_t w = 0; w < kWheels; ++w) EXPECT_NEAR(rotor_rpm(rig, w), 300.0, 6.0) << w;
  const BusFrame answer = rig.wire->last(2);
  EXPECT_EQ(data_of(answer)[4], 1);
  EXPECT_NEAR(word(answer, 5), 300.0, 6.0);
  EXPECT_EQ(word(answer, 7), 0);
  EXPECT_EQ(answer.data[9], autosar({answer.data.begin(), answer.data.begin() + 9}));
  rig.run_ms(500, [&] { rig.send(speed(0, ++sequence, 300, false)); });
  EXPECT_EQ(rig.firmware->feedback().duty_ratio[0], 0.0) << "not enabled";
}

// Two buffers: the transfer after the next carries the answer.
TEST(ThunderbotsSpiTest, an_answer_leaves_with_the_second_transfer_after_the_one_it_answers) {
  BusRig rig("thunderbots-spi");
  std::vector<int> sequences;
  for (std::uint8_t i = 1; i <= 5; ++i) {
    rig.send(transfer(1, i, 0, {}));
    rig.run_ms(1);
    ASSERT_EQ(rig.wire->from_motors.size(), i);
  }
  for (const BusFrame& f : rig.wire->from_motors) sequences.push_back(f.data[3]);
  EXPECT_EQ(sequences, (std::vector<int>{0, 0, 1, 2, 3}));
}

TEST(ThunderbotsSpiTest, frames_out_of_order_and_damaged_ones_move_nothing_and_are_counted) {
  BusRig rig("thunderbots-spi");
  rig.send(speed(0, 7, 300));  // after the start only 0 and 1 come next
  BusFrame damaged = speed(0, 1, 300);
  damaged.data[6] ^= 1;
  rig.send(damaged);
  BusFrame shorter = speed(0, 1, 300);
  shorter.size = 9;
  rig.send(shorter);
  rig.send(transfer(0, 1, 9, {}));
  rig.run_ms(50);
  EXPECT_EQ(rig.count(BusVerdict::kUnsupported), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kMalformed), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kLength), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kUnknownCommand), 1U);
  EXPECT_EQ(rotor_rpm(rig, 0), 0.0);
  rig.run_ms(300, [&] { rig.send(speed(0, 2, 300)); });  // the same again and again is a frame sent again
  EXPECT_GT(rotor_rpm(rig, 0), 200.0);
}

TEST(ThunderbotsSpiTest, answers_hold_what_was_asked_for) {
  BusRig rig("thunderbots-spi");
  std::uint8_t sequence = 0;
  for (const std::uint8_t type : {7, 5, 2, 3, 4, 6, 1}) {
    rig.send(transfer(3, ++sequence, 3, {type}));
    rig.run_ms(200, [&] { rig.send(speed(3, ++sequence, 200)); });
    const BusFrame answer = rig.wire->last(3);
    EXPECT_EQ(answer.data[4], type);
    if (type == 7) {
      EXPECT_EQ(word(answer, 7), 200);
    }
    if (type == 7 || type == 1) {
      EXPECT_NEAR(word(answer, 5), 200, 60);
    }
    if (type == 2 || type == 3 || type == 6) {
      EXPECT_EQ(word(answer, 7), 0);
    }
  }
  rig.send(transfer(3, ++sequence, 3, {8}));
  rig.run_ms(1);
  EXPECT_EQ(rig.count(BusVerdict::kUnsupported), 1U);
}

}  // namespace
}  // namespace omnihil::test
