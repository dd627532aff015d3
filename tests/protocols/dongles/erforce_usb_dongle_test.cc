// ER-Force's USB transceiver: records, what it answers itself, and what its robots do.
#include <cmath>

#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

constexpr const char* kId = "erforce-usb-pasta-2014";

TEST(ErForceUsb, AnswersInitPingAndStatusItself) {
  Bench bench(kId, {.robot_ids = {3}});
  bench.write(bench.encode("init", {{"protocol_version", 7}}) + bench.encode("ping", {{"time", -5}}) +
              bench.encode("status", {}) + bench.encode("set_frequency", {{"channel", 10}}));
  bench.run_to(2 * kMs);
  EXPECT_EQ(bench.to_host,
            (Bytes{2, 0x80, 5, 0, 8, 0x81, 0xFB, 255, 255, 255, 255, 255, 255, 255, 4, 0x82, 0, 0, 0, 0}));
  EXPECT_EQ(bench.good(), 4u);
}

TEST(ErForceUsb, ByteFourOfTheAddressIsIgnoredAndKept) {
  Bench bench(kId, {.robot_ids = {3}});
  Bytes command = bench.encode("gen2014_command", {{"address_id", 3}, {"id", 3}, {"v_f", 1.5}, {"v_s", 0.5}});
  for (const std::uint8_t whatever : {std::uint8_t{0}, std::uint8_t{0x5A}, std::uint8_t{0xFF}}) {
    command[6] = whatever;
    const DecodeResult result = bench.format.decode(command);
    ASSERT_EQ(result.error, PacketError::kNone);
    Bytes again;
    bench.format.encode(result.values, again);
    EXPECT_EQ(again, command);
    bench.write(command);
  }
  bench.run_to(2 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 3u);
  for (const Heard& heard : bench.sink.heard) {
    EXPECT_EQ(heard.command.flags, 0u);
    EXPECT_NEAR(heard.command.v_forward_m_s, 1.5, 1e-6);
    EXPECT_NEAR(heard.command.v_left_m_s, -0.5, 1e-6) << "v_s is to the right";
  }
}

TEST(ErForceUsb, FloatsAreCutOffTowardsZeroAndHeldToTheEnds) {
  Bench bench(kId, {.robot_ids = {3}});
  const Bytes bytes =
      bench.encode("pasta_command", {{"v_x", -1.9999}, {"v_y", 40.0}, {"omega", -40.0}, {"dribbler", 2.0}});
  const auto word = [&](std::size_t at) { return static_cast<std::int16_t>(bytes[at] | bytes[at + 1] << 8); };
  EXPECT_EQ(static_cast<std::int8_t>(bytes[11]), 100);
  EXPECT_EQ(word(12), -1999);
  EXPECT_EQ(word(14), 32767);
  EXPECT_EQ(word(16), -32767) << "8000h is no number";
}

TEST(ErForceUsb, PastaDrivesInTheFieldFrameAndAnswers) {
  Bench bench(kId, {.robot_ids = {3, 9}});
  bench.robots[9].v_forward_m_s = 1.25;
  bench.robots[9].v_left_m_s = -0.75;
  bench.robots[9].omega_body_rad_s = 2.0;
  bench.step();
  bench.write(
      bench.encode("pasta_command", {{"address_id", 9}, {"counter", 77}, {"v_x", 1.0}, {"v_y", 2.0}}));
  bench.run_to(3 * kMs);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].robot, 9);
  EXPECT_EQ(bench.sink.heard[0].command.flags, unsigned{OMNIHIL_COMMAND_FIELD_FRAME});
  const auto answers = bench.answers("response");
  ASSERT_EQ(answers.size(), 1u);
  const Values& state = answers[0].values;
  EXPECT_EQ(state.number("generation"), 3.0);
  EXPECT_EQ(state.number("counter"), 77.0);
  EXPECT_EQ(state.number("id"), 9.0);
  EXPECT_NEAR(state.number("v_s"), 0.75, 1e-3);
  EXPECT_NEAR(state.number("v_f"), 1.25, 1e-3);
  EXPECT_NEAR(state.number("omega"), 2.0, 1e-3);
}

TEST(ErForceUsb, ARecordOfAnotherLengthIsRefusedAndTheNextIsFound) {
  Bench bench(kId, {.robot_ids = {3}});
  bench.write(Bytes{0x11, 3, 1, 2, 3, 0x77, 0x77} + bench.encode("ping", {{"time", 1}}));
  bench.run_to(2 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kTooShort), 1u);
  EXPECT_EQ(bench.refused(PacketError::kFraming), 1u) << "one run of bytes that begin no record";
  EXPECT_EQ(bench.good(), 1u);
}

}  // namespace
}  // namespace omnihil
