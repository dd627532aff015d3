// moteus: bytes by the vendor's register documentation, behaviour of the modes, the loop through the plant.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "firmware_iface/motor_bus/multiplex.h"
#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

constexpr std::uint32_t kTo1 = 0x8001, kFrom1 = 0x0100;
constexpr std::uint32_t to(std::uint32_t device) { return 0x8000U | device; }

// Position mode, position NaN ("where it is"), velocity 3.0f, and a query of mode.
const char* const kThreeTurns = "01 00 0a  0e 20 0000c07f 00004040  11 00";

void command_all(BusRig& rig, const char* data) {
  for (std::uint32_t device = 1; device <= 4; ++device) rig.send(fd_frame(to(device), data));
}
std::vector<std::uint8_t> ask(BusRig& rig, const char* data) {
  rig.wire->from_motors.clear();
  rig.send(fd_frame(kTo1, data));
  rig.run_ms(1);
  return data_of(rig.wire->last(kFrom1));
}

TEST(MoteusTest, what_fills_an_answer_up_to_a_length_of_can_fd_says_nothing) {
  BusRig rig("moteus");
  rig.send(fd_frame(kTo1, "11 00"));
  rig.run_ms(1);
  const BusFrame answer = rig.wire->last(kFrom1);
  ASSERT_EQ(data_of(answer), hex("21 00 00"));
  std::vector<RegisterAccess> said;
  EXPECT_EQ(read_multiplex(std::vector<std::uint8_t>(5, answer.pad), said), MultiplexStatus::kOk);
  EXPECT_TRUE(said.empty());
}

TEST(MultiplexTest, reads_the_vendors_example) {
  std::vector<RegisterAccess> a;
  ASSERT_EQ(read_multiplex(hex("01000a07206000200150ff140400130d"), a), MultiplexStatus::kOk);
  ASSERT_EQ(a.size(), 11U);  // 4 written, 4 + 3 asked for
  EXPECT_TRUE(a[0].write && a[0].reg == 0 && a[0].value.integer == 10);
  EXPECT_EQ(a[1].reg, 0x020U);
  EXPECT_NEAR(a[1].value.scaled({0.01, 1e-4, 1e-5}) * 360.0, 3.456, 1e-9);    // 96 counts of 0.036 degrees
  EXPECT_NEAR(a[2].value.scaled({0.1, 0.00025, 1e-5}) * 360.0, 25.92, 1e-9);  // 288 counts of 0.09 dps
  EXPECT_NEAR(a[3].value.scaled({0.5, 0.01, 0.001}), -1.76, 1e-9);
  EXPECT_TRUE(!a[4].write && a[4].reg == 0 && a[4].value.type == MultiplexType::kInt16);
  EXPECT_TRUE(!a[10].write && a[10].reg == 0x00F && a[10].value.type == MultiplexType::kInt8);
}

TEST(MultiplexTest, writes_the_vendors_example) {
  std::array<std::uint8_t, 64> out{};
  MultiplexReply reply(out);
  reply.add_whole(0, MultiplexType::kInt16, 10);
  reply.add(1, MultiplexType::kInt16, 2.88 / 360.0 + 1e-9, {0.01, 1e-4, 1e-5});
  reply.add(2, MultiplexType::kInt16, 23.04 / 360.0 + 1e-9, {0.1, 0.00025, 1e-5});
  reply.add(3, MultiplexType::kInt16, -1.44 - 1e-9, {0.5, 0.01, 0.001});
  reply.add(0x00D, MultiplexType::kInt8, 12.0, {0.5, 0.1, 0.001});
  reply.add(0x00E, MultiplexType::kInt8, 20.0, {1.0, 0.1, 0.001});
  reply.add_whole(0x00F, MultiplexType::kInt8, 0);
  EXPECT_EQ(std::vector<std::uint8_t>(out.begin(), out.begin() + static_cast<long>(reply.size())),
            hex("2404000a005000000170ff230d181400"));
}

TEST(MultiplexTest, integers_saturate_and_the_most_negative_is_no_number) {
  std::array<std::uint8_t, 64> out{};
  MultiplexReply reply(out);
  reply.add(1, MultiplexType::kInt8, 5.0, {0.01, 1e-4, 1e-5});   // 500 counts -> 127
  reply.add(2, MultiplexType::kInt8, -5.0, {0.01, 1e-4, 1e-5});  // -> -127
  reply.add(3, MultiplexType::kInt8, std::nan(""), {0.01, 1e-4, 1e-5});
  EXPECT_EQ(std::vector<std::uint8_t>(out.begin(), out.begin() + 5), hex("23 01 7f 81 80"));
  std::vector<RegisterAccess> a;
  ASSERT_EQ(read_multiplex(hex("01 20 80"), a), MultiplexStatus::kOk);
  EXPECT_TRUE(std::isnan(a[0].value.scaled({0.01, 1e-4, 1e-5})));
}

TEST(MultiplexTest, counts_may_stand_in_a_byte_of_their_own_and_registers_beyond_7f) {
  std::vector<RegisterAccess> a;
  ASSERT_EQ(read_multiplex(hex("18 05 a0 02  50 50"), a), MultiplexStatus::kOk);
  ASSERT_EQ(a.size(), 5U);
  EXPECT_EQ(a[0].reg, 0x120U);
  EXPECT_EQ(a[0].value.type, MultiplexType::kInt32);
}

TEST(MultiplexTest, cut_frames_and_foreign_subframes_are_refused) {
  std::vector<RegisterAccess> a;
  const std::vector<std::uint8_t> whole = hex("01000a0720600020 0150ff");
  for (const std::size_t cut : {1U, 2U, 4U, 5U, 7U, 10U}) {
    EXPECT_EQ(read_multiplex(std::span(whole).first(cut), a), MultiplexStatus::kTruncated) << cut;
  }
  EXPECT_EQ(read_multiplex(hex("40 01 02 61 62"), a), MultiplexStatus::kUnknownSubframe);
  EXPECT_EQ(read_multiplex(hex("10 ff ff ff ff ff 00"), a), MultiplexStatus::kTruncated);
}

TEST(MoteusTest, answers_a_query_only_when_the_source_asks_for_it) {
  BusRig rig("moteus");
  EXPECT_EQ(ask(rig, "11 00"), hex("21 00 00"));  // mode 0, stopped
  rig.wire->from_motors.clear();
  rig.send(fd_frame(0x0001, "11 00"));
  rig.run_ms(1);
  EXPECT_TRUE(rig.wire->from_motors.empty());
  rig.send(fd_frame(0x8503, "11 00"));  // device 3, from source 5
  rig.run_ms(1);
  EXPECT_EQ(data_of(rig.wire->last(0x0305)), hex("21 00 00"));
}

TEST(MoteusTest, a_commanded_velocity_is_reached_in_the_plant) {
  BusRig rig("moteus");
  rig.run_ms(1500, [&] { command_all(rig, kThreeTurns); });
  for (std::size_t w = 0; w < kWheels; ++w) EXPECT_NEAR(rig.rotor_turns_s(w), 3.0, 0.02 * 3.0) << w;
  const std::vector<std::uint8_t> answer = ask(rig, "1e 01");  // 2 floats from register 1
  ASSERT_EQ(answer.size(), 10U);
  // the estimate moves in steps that one count may look like: 0.02 m/s at the rim
  const RobotModel& robot = rig.session->config().robots[0];
  const double step_turns_s = 0.02 * robot.gear_ratio / robot.wheel_radius_m / 6.283185307;
  EXPECT_NEAR(std::bit_cast<float>(get_le<std::uint32_t>(answer, 6)), rig.rotor_turns_s(0), step_turns_s);
}

TEST(MoteusTest, velocity_rises_by_the_commanded_acceleration) {
  BusRig rig("moteus");
  // NaN position, velocity 3.0f; acceleration limit 2.0f turns/s^2
  rig.run_ms(1000, [&] { command_all(rig, "01 00 0a  0e 20 0000c07f 00004040  0d 29 00000040"); });
  const std::vector<std::uint8_t> answer = ask(rig, "1d 39");  // control velocity
  EXPECT_NEAR(std::bit_cast<float>(get_le<std::uint32_t>(answer, 2)), 2.0 * 1.0, 0.01);
  EXPECT_NEAR(rig.rotor_turns_s(0), 2.0 * 1.0, 0.1 * 2.0);  // a loop of some 10 rad/s behind a ramp
}

TEST(MoteusTest, a_commanded_position_is_reached_without_overshoot_of_the_trajectory) {
  BusRig rig("moteus");
  double most = 0;
  // position 2.0f, velocity 0; velocity limit 4, acceleration limit 8
  rig.run_ms(4000, [&] {
    command_all(rig, "01 00 0a  0e 20 00000040 00000000  0e 28 00008040 00000041");
    most = std::max(most, rig.session->plant().truth(0).theta_rotor_rad[0] / 6.283185307);
  });
  // No integral: it stops where friction holds kp times what is left, and says so.
  const double turns = rig.session->plant().truth(0).theta_rotor_rad[0] / 6.283185307;
  EXPECT_NEAR(turns, 2.0, 0.1);
  const std::vector<std::uint8_t> error = ask(rig, "1d 3b");
  EXPECT_NEAR(std::bit_cast<float>(get_le<std::uint32_t>(error, 2)), turns - 2.0, 0.005);
  EXPECT_LT(most, 2.0 + 0.3);
  EXPECT_EQ(ask(rig, "11 0b"), hex("21 0b 01"));
}

TEST(MoteusTest, without_commands_for_100_ms_it_damps_until_it_is_stopped) {
  BusRig rig("moteus");
  rig.run_ms(1000, [&] { command_all(rig, kThreeTurns); });
  rig.run_ms(95);
  EXPECT_EQ(rig.firmware->timeouts(), 0U);
  rig.run_ms(10);
  EXPECT_EQ(rig.firmware->timeouts(), 4U);
  rig.run_ms(1500);
  EXPECT_LT(std::abs(rig.rotor_turns_s(0)), 0.1);
  EXPECT_EQ(ask(rig, "11 00"), hex("21 00 0b"));      // mode 11
  EXPECT_EQ(ask(rig, kThreeTurns), hex("21 00 0b"));  // a position command does not lead out of it
  rig.run_ms(5);
  EXPECT_EQ(ask(rig, "01 00 00  11 00"), hex("21 00 00"));  // stopped does
  EXPECT_EQ(ask(rig, kThreeTurns), hex("21 00 0a"));
}

TEST(MoteusTest, a_command_may_ask_for_no_timeout) {
  BusRig rig("moteus");
  command_all(rig, "01 00 0a  0e 20 0000c07f 00004040  0d 27 0000c07f");
  rig.run_ms(1500);
  EXPECT_NEAR(rig.rotor_turns_s(0), 3.0, 0.02 * 3.0);
  EXPECT_EQ(rig.firmware->timeouts(), 0U);
}

TEST(MoteusTest, current_mode_gives_the_torque_of_that_current) {
  BusRig rig("moteus");
  rig.run_ms(100, [&] { command_all(rig, "01 00 09  0d 1c 0000003f"); });  // 0.5 A
  const std::vector<std::uint8_t> answer = ask(rig, "1e 03");              // torque, Q current
  const double k = rig.session->config().robots[0].motor.torque_constant_Nm_per_A;
  EXPECT_NEAR(std::bit_cast<float>(get_le<std::uint32_t>(answer, 6)), 0.5, 0.1 * 0.5);
  EXPECT_NEAR(std::bit_cast<float>(get_le<std::uint32_t>(answer, 2)), 0.5 * k, 0.1 * 0.5 * k);
}

TEST(MoteusTest, unknown_and_read_only_registers_are_answered_with_errors) {
  BusRig rig("moteus");
  EXPECT_EQ(ask(rig, "11 7a"), hex("31 7a 01"));
  EXPECT_EQ(ask(rig, "0d 01 00000000"), hex("30 01 02"));
  EXPECT_EQ(ask(rig, "01 00 0e"), hex("30 00 01"));  // measure inductance
  EXPECT_EQ(rig.count(BusVerdict::kUnsupported), 2U);
}

TEST(MoteusTest, a_frame_with_a_fault_in_it_moves_nothing) {
  BusRig rig("moteus");
  rig.run_ms(200, [&] {
    command_all(rig, "01 00 0a  0e 20 0000c07f 00004040  0d 40 00000000");  // stay-within bound: unsupported
    command_all(rig, "01 00 0a  0e 20 0000c07f 0000");                      // cut
    command_all(rig, "01 00 0a  0d 21 0000807f");                           // infinite
  });
  EXPECT_EQ(rig.rotor_turns_s(0), 0.0);
  EXPECT_EQ(rig.count(BusVerdict::kUnsupported), 800U);
  EXPECT_EQ(rig.count(BusVerdict::kMalformed), 800U);
  EXPECT_EQ(rig.count(BusVerdict::kNotFinite), 800U);
  rig.send(fd_frame(to(9), "11 00"));
  rig.run_ms(1);
  EXPECT_EQ(rig.count(BusVerdict::kNotOurs), 1U);
}

}  // namespace
}  // namespace omnihil::test
