// ibis' serial line: the network's command behind another first byte, with camera and sum.
#include "tests/protocols/dongles/links_harness.h"

namespace omnihil {
namespace {

TEST(IbisUart, BytesOneTo63AreThoseOfTheNetworksCommand) {
  const FieldValues fields{
      {"check_counter", 42}, {"mode_args.target_global_vel[0]", 1.5}, {"target_global_theta", 1.0}};
  const Bytes network = encode(*find_radio_format("ibis-robot-command-v2"), "SIMPLE_VELOCITY_TARGET", fields);
  const Bytes serial = encode(*find_radio_format("ibis-uart72"), "SIMPLE_VELOCITY_TARGET", fields);
  ASSERT_EQ(serial.size(), 72u);
  EXPECT_EQ(serial[0], 0xFE);
  EXPECT_TRUE(std::equal(network.begin() + 1, network.end(), serial.begin() + 1));
  unsigned sum = 0;
  for (std::size_t i = 0; i < 71; ++i) sum += serial[i];
  EXPECT_EQ(serial[71], sum % 256);
}

TEST(IbisUart, CameraValuesAreBigEndian) {
  const Bytes bytes =
      encode(*find_radio_format("ibis-uart72"), "POSITION_TARGET",
             {{"camera[0]", 0x0102}, {"camera[1]", 0x0304}, {"camera[2]", 0x0506}, {"camera[3]", 7}});
  EXPECT_EQ(Bytes(bytes.begin() + 64, bytes.begin() + 71), (Bytes{1, 2, 3, 4, 5, 6, 7}));
}

TEST(IbisUart, TheBoardDrivesAnswersAndRefusesAWrongSum) {
  Bench bench("ibis-uart72", {.robot_ids = {3}});
  bench.boot_robots();
  bench.step();
  Bytes damaged = bench.encode("SIMPLE_VELOCITY_TARGET", {});
  damaged[20] ^= 1;
  bench.write(damaged);
  bench.write(bench.encode("SIMPLE_VELOCITY_TARGET",
                           {{"check_counter", 9}, {"mode_args.target_global_vel[1]", -0.5}}));
  bench.run_to(5 * kMs);
  EXPECT_EQ(bench.refused(PacketError::kChecksum), 1u);
  ASSERT_EQ(bench.sink.heard.size(), 1u);
  EXPECT_EQ(bench.sink.heard[0].at_ns, 720 * kUs) << "72 bytes at 1 Mbaud";
  EXPECT_NEAR(bench.sink.heard[0].command.v_left_m_s, -0.5, 1e-3);
  const auto answers = bench.answers("FEEDBACK");
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].values.number("check_counter"), 9.0);
}

}  // namespace
}  // namespace omnihil
