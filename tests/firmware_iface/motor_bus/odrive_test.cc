// ODrive CANSimple: bytes by the vendor's message table, behaviour of the axis, the loop through the plant.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

// id = node << 5 | command
constexpr std::uint32_t id(std::uint32_t node, std::uint32_t command) { return node << 5 | command; }
const char* const kClosedLoop = "08 00 00 00";
const char* const kFiveTurns = "00 00 A0 40 00 00 00 00";  // 5.0f, 0.0f

void arm(BusRig& rig) {
  for (std::uint32_t node = 0; node < 4; ++node) rig.send(frame(id(node, 0x07), kClosedLoop));
}
void command_all(BusRig& rig, std::uint32_t command, const char* data) {
  for (std::uint32_t node = 0; node < 4; ++node) rig.send(frame(id(node, command), data));
}

TEST(OdriveTest, ids_carry_node_and_command) { EXPECT_EQ(id(1, 0x0C), 0x2CU); }

TEST(OdriveTest, heartbeat_comes_every_100_ms_and_estimates_every_10_ms) {
  BusRig rig("odrive");
  rig.run_ms(1000);
  int heartbeats = 0, estimates = 0;
  for (const BusFrame& f : rig.wire->from_motors) {
    heartbeats += f.id == id(2, 0x01);
    estimates += f.id == id(2, 0x09);
  }
  EXPECT_EQ(heartbeats, 1000 / 100);
  EXPECT_EQ(estimates, 1000 / 10);
  // no error, axis state 1 (idle), result 0, trajectory done
  EXPECT_EQ(data_of(rig.wire->last(id(2, 0x01))), hex("00000000 01 00 01 00"));
}

TEST(OdriveTest, an_idle_axis_does_not_follow_set_points) {
  BusRig rig("odrive");
  command_all(rig, 0x0D, kFiveTurns);
  rig.run_ms(300);
  EXPECT_EQ(rig.rotor_turns_s(0), 0.0);
}

TEST(OdriveTest, a_commanded_speed_is_reached_in_the_plant) {
  BusRig rig("odrive");
  arm(rig);
  command_all(rig, 0x0D, kFiveTurns);
  rig.run_ms(1500);
  for (std::size_t w = 0; w < kWheels; ++w) EXPECT_NEAR(rig.rotor_turns_s(w), 5.0, 0.02 * 5.0) << w;
  EXPECT_NEAR(get_f32(rig.wire->last(id(1, 0x09)), 4), 5.0, 0.02 * 5.0);
}

// Geared and direct, encoders that count backwards, drives of three phases: the same 0.5 m/s at the rims.
TEST(OdriveTest, the_speed_loop_follows_on_every_shipped_robot) {
  for (const char* model : {"omni_default", "omni_ec45_30w", "omni_foc", "roboteam_2024", "ulaval_delta"}) {
    BusRig rig("odrive", {}, BusShaft::kWheel, model);
    const double turns_s = 0.5 / (2.0 * 3.14159265358979 * rig.session->config().robots[0].wheel_radius_m);
    BusFrame speed = can_frame(0, 8);
    put_f32(speed, 0, turns_s);
    arm(rig);
    for (std::uint32_t node = 0; node < 4; ++node) {
      speed.id = id(node, 0x0D);
      rig.send(speed);
    }
    rig.run_ms(2500);
    for (std::size_t w = 0; w < kWheels; ++w) {
      EXPECT_NEAR(rig.rotor_turns_s(w), turns_s * rig.gear(), 0.02 * turns_s * rig.gear())
          << model << " " << w;
    }
  }
}

TEST(OdriveTest, turns_may_be_those_of_the_wheel) {
  BusRig rig("odrive", {}, BusShaft::kWheel);
  arm(rig);
  command_all(rig, 0x0D, "00 00 00 40 00 00 00 00");  // 2 turns/s
  rig.run_ms(1500);
  EXPECT_NEAR(rig.rotor_turns_s(3), 2.0 * rig.gear(), 0.02 * 2.0 * rig.gear());
}

TEST(OdriveTest, motors_follow_the_order_that_is_asked_for) {
  BusRig rig("odrive", {.order = {2, 3, 0, 1}});
  rig.send(frame(id(0, 0x07), kClosedLoop));
  rig.send(frame(id(0, 0x0D), kFiveTurns));
  rig.run_ms(50);
  EXPECT_GT(rig.rotor_turns_s(2), 1.0);
}

TEST(OdriveTest, position_control_goes_there_and_stays) {
  BusRig rig("odrive");
  rig.send(frame(id(0, 0x0B), "03 00 00 00 01 00 00 00"));
  for (std::uint32_t node = 1; node < 4; ++node) rig.send(frame(id(node, 0x0B), "03 00 00 00 01 00 00 00"));
  for (std::uint32_t node = 0; node < 4; ++node) rig.send(frame(id(node, 0x1A), "00 00 A0 40"));  // 5 1/s
  arm(rig);
  command_all(rig, 0x0C, "00 00 40 40 00 00 00 00");  // 3.0f turns, no feed-forward
  rig.run_ms(4000);
  EXPECT_NEAR(get_f32(rig.wire->last(id(0, 0x09)), 0), 3.0, 0.05);
}

TEST(OdriveTest, torque_control_gives_the_torque_while_the_wheel_is_slow) {
  BusRig rig("odrive");
  command_all(rig, 0x0B, "01 00 00 00 01 00 00 00");
  arm(rig);
  command_all(rig, 0x0E, "0A D7 A3 3C");  // 0.02f N m
  rig.run_ms(100);
  rig.send(remote_frame(id(0, 0x1C)));
  rig.run_ms(1);
  const BusFrame torques = rig.wire->last(id(0, 0x1C));
  EXPECT_FLOAT_EQ(get_f32(torques, 0), 0.02F);
  EXPECT_NEAR(get_f32(torques, 4), 0.02, 0.1 * 0.02);
}

TEST(OdriveTest, without_a_watchdog_silence_changes_nothing) {
  BusRig rig("odrive");
  arm(rig);
  command_all(rig, 0x0D, kFiveTurns);
  rig.run_ms(5000);
  EXPECT_NEAR(rig.rotor_turns_s(0), 5.0, 0.02 * 5.0);
  EXPECT_EQ(rig.firmware->timeouts(), 0U);
}

TEST(OdriveTest, an_expired_watchdog_disarms_until_errors_are_cleared) {
  BusRig rig("odrive", {.watchdog_s = 0.05});
  arm(rig);
  rig.run_ms(500, [&] { command_all(rig, 0x0D, kFiveTurns); });
  const double before = rig.rotor_turns_s(0);
  rig.run_ms(200);
  EXPECT_LT(rig.rotor_turns_s(0), before);
  EXPECT_EQ(rig.firmware->timeouts(), 4U);
  // error 0x01000000, state 1, result 3 (disarmed)
  EXPECT_EQ(data_of(rig.wire->last(id(0, 0x01))), hex("00000001 01 03 01 00"));
  arm(rig);  // refused: the error stands
  rig.run_ms(100);
  EXPECT_EQ(rig.wire->last(id(0, 0x01)).data[4], 1);
  command_all(rig, 0x18, "00");
  arm(rig);
  rig.run_ms(100, [&] { command_all(rig, 0x0D, kFiveTurns); });
  EXPECT_EQ(data_of(rig.wire->last(id(0, 0x01))), hex("00000000 08 00 01 00"));
}

TEST(OdriveTest, an_estop_disarms_its_axis_alone) {
  BusRig rig("odrive");
  arm(rig);
  rig.send(frame(id(1, 0x02), ""));
  rig.run_ms(101);
  EXPECT_EQ(data_of(rig.wire->last(id(1, 0x01))), hex("00000002 01 03 01 00"));
  rig.run_ms(100);
  EXPECT_EQ(rig.wire->last(id(0, 0x01)).data[4], 8);
}

TEST(OdriveTest, remote_requests_are_answered_with_the_plants_values) {
  BusRig rig("odrive");
  rig.run_ms(5);
  rig.send(remote_frame(id(3, 0x17)));
  rig.send(remote_frame(id(3, 0x03)));
  rig.run_ms(1);
  EXPECT_EQ(data_of(rig.wire->last(id(3, 0x03))), hex("00000000 00000000"));
  rig.send(remote_frame(id(3, 0x17)));
  rig.run_ms(1);
  EXPECT_NEAR(get_f32(rig.wire->last(id(3, 0x17)), 0), rig.session->config().robots[0].bus_voltage_V, 0.01);
}

TEST(OdriveTest, bad_frames_are_counted_by_cause_and_move_nothing) {
  BusRig rig("odrive");
  arm(rig);
  rig.run_ms(2);
  rig.send(fd_frame(id(0, 0x0D), kFiveTurns));              // CAN FD
  rig.send(frame(id(0, 0x0D), "00 00 A0 40"));              // half of it
  rig.send(frame(id(0, 0x0D), "00 00 C0 7F 00000000"));     // NaN
  rig.send(frame(id(0, 0x0D), "00 00 00 00 0000807F"));     // infinite feed-forward
  rig.send(frame(id(0, 0x1E), kFiveTurns));                 // no such command
  rig.send(frame(id(0, 0x07), "04 00 00 00"));              // calibration
  rig.send(frame(id(0, 0x0B), "02 00 00 00 05 00 00 00"));  // trapezoidal trajectory
  rig.send(frame(id(17, 0x0D), kFiveTurns));                // another node
  rig.run_ms(300);
  EXPECT_EQ(rig.count(BusVerdict::kWrongKind), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kLength), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kNotFinite), 2U);
  EXPECT_EQ(rig.count(BusVerdict::kUnknownCommand), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kUnsupported), 2U);
  EXPECT_EQ(rig.count(BusVerdict::kNotOurs), 1U);
  EXPECT_LT(std::abs(rig.rotor_turns_s(0)), 0.01);
}

}  // namespace
}  // namespace omnihil::test
