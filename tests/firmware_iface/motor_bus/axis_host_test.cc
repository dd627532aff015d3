// The host's end of a bus against the simulated devices of the same bus, and its bytes against the vendors' tables.
#include "firmware_iface/motor_bus/axis_host.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware_iface/motor_bus/multiplex.h"
#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

// One motor of the rig behind its host's end: frames go over, answers come back every millisecond.
struct Driven {
  BusRig rig;
  std::unique_ptr<AxisHost> host;
  int samples = 0;

  Driven(std::string_view bus, int id) : rig(bus), host(find_motor_bus(bus)->host(id)) {}
  void put(const std::vector<BusFrame>& frames) {
    for (const BusFrame& f : frames) rig.send(f);
  }
  void ask(AxisDemand demand, double value) {
    std::vector<BusFrame> frames;
    host->ask(demand, value, frames);
    put(frames);
  }
  void stop() {
    std::vector<BusFrame> frames;
    host->stop(frames);
    put(frames);
  }
  void run_ms(int ms) {
    rig.run_ms(ms);
    for (const BusFrame& f : rig.wire->from_motors) samples += host->hear(f) ? 1 : 0;
    rig.wire->from_motors.clear();
  }
};

std::vector<std::uint8_t> data_of_only(const std::vector<BusFrame>& frames) {
  EXPECT_EQ(frames.size(), 1U);
  return data_of(frames.at(0));
}

// 01 00 08: int8 mode 8; 0d 1b f32: Q voltage 2.5; reads of mode, four values, bus, fault.
TEST(MoteusHost, asks_for_a_voltage_as_the_register_table_has_it) {
  std::vector<BusFrame> frames;
  find_motor_bus("moteus")->host(1)->ask(AxisDemand::kVoltage, 2.5, frames);
  EXPECT_EQ(data_of_only(frames), hex("010008 0d1b00002040 1100 1c0401 1d0d 110f"));
  EXPECT_EQ(frames[0].id, 0x8001U);
  EXPECT_TRUE(frames[0].extended && frames[0].fd);
}

TEST(MoteusHost, stops_before_it_asks_for_anything) {
  std::vector<BusFrame> frames;
  find_motor_bus("moteus")->host(3)->stop(frames);
  const std::vector<std::uint8_t> data = data_of_only(frames);
  EXPECT_EQ((std::vector<std::uint8_t>{data.begin(), data.begin() + 3}), hex("010000"));
  EXPECT_EQ(frames[0].id, 0x8003U);
}

// u = k omega at no load: V in, V / k out, less what friction takes (some per cent in a wheel that is held by nothing).
TEST(MoteusHost, a_voltage_turns_the_simulated_motor_and_every_question_is_a_sample) {
  Driven d("moteus", 1);
  for (int n = 0; n < 300; ++n) {
    d.ask(AxisDemand::kVoltage, 3.0);
    d.run_ms(2);
  }
  EXPECT_GE(d.samples, 298);
  EXPECT_EQ(d.host->state().trouble, "");
  EXPECT_NEAR(d.host->state().turns_s, d.rig.rotor_turns_s(0), 0.05 * std::abs(d.rig.rotor_turns_s(0)));
  EXPECT_GT(std::abs(d.rig.rotor_turns_s(0)), 1.0);
  EXPECT_NEAR(d.host->state().bus_V, d.rig.session->config().robots[0].bus_voltage_V, 2.0);
}

TEST(MoteusHost, a_torque_is_held_by_the_device_for_its_time_out_alone) {
  Driven d("moteus", 2);
  for (int n = 0; n < 50; ++n) {
    d.ask(AxisDemand::kTorque, 0.02);
    d.run_ms(2);
  }
  EXPECT_NEAR(d.host->state().torque_Nm, 0.02, 0.004);
  EXPECT_EQ(d.host->state().trouble, "");
  d.run_ms(500);  // nobody asks: 0.1 s
  d.ask(AxisDemand::kTorque, 0.02);
  d.run_ms(2);
  EXPECT_EQ(d.host->state().trouble, "the moteus had no command within its time-out");
  d.stop();
  d.run_ms(2);
  EXPECT_EQ(d.host->state().trouble, "");
}

TEST(OdriveHost, arms_the_axis_then_asks_for_torque_and_for_what_it_measures) {
  std::vector<BusFrame> frames;
  const auto host = find_motor_bus("odrive")->host(1);
  host->ask(AxisDemand::kTorque, 0.5, frames);
  ASSERT_EQ(frames.size(), 6U);
  EXPECT_EQ(frames[0].id, 0x2BU);  // Set_Controller_Mode: torque, pass-through
  EXPECT_EQ(data_of(frames[0]), hex("01000000 01000000"));
  EXPECT_EQ(frames[1].id, 0x27U);  // Set_Axis_State: closed loop
  EXPECT_EQ(data_of(frames[1]), hex("08000000"));
  EXPECT_EQ(frames[2].id, 0x2EU);  // Set_Input_Torque
  EXPECT_EQ(data_of(frames[2]), hex("0000003f"));
  for (std::size_t k = 3; k < 6; ++k) EXPECT_TRUE(frames[k].remote);
  frames.clear();
  host->ask(AxisDemand::kTorque, 0.25, frames);
  EXPECT_EQ(frames[0].id, 0x2EU);  // armed once
  frames.clear();
  host->stop(frames);
  EXPECT_EQ(data_of(frames[0]), hex("00000000"));
  EXPECT_EQ(data_of(frames[1]), hex("01000000"));  // idle
  EXPECT_FALSE(host->can(AxisDemand::kVoltage));
}

TEST(OdriveHost, a_torque_turns_the_simulated_motor_and_a_stop_lets_it_go) {
  Driven d("odrive", 0);
  for (int n = 0; n < 100; ++n) {
    d.ask(AxisDemand::kTorque, 0.03);
    d.run_ms(2);
  }
  EXPECT_GE(d.samples, 98);
  EXPECT_GT(std::abs(d.host->state().turns_s), 0.5);
  EXPECT_GT(d.host->state().q_current_A, 0.1);
  d.stop();
  d.run_ms(20);
  d.stop();
  d.run_ms(5);
  EXPECT_NEAR(d.host->state().q_current_A, 0.0, 0.05);
}

TEST(OdriveHost, an_error_that_the_device_reports_is_named) {
  const auto host = find_motor_bus("odrive")->host(0);
  std::vector<BusFrame> frames;
  host->ask(AxisDemand::kTorque, 0.1, frames);
  host->hear(frame(0x001, "00000000 01 00 01 00"));  // of before: idle
  EXPECT_EQ(host->state().trouble, "");
  host->hear(frame(0x001, "00000000 01 00 01 00"));
  EXPECT_EQ(host->state().trouble, "the ODrive does not go into closed loop control");
  host->hear(frame(0x001, "00000000 08 00 01 00"));
  EXPECT_EQ(host->state().trouble, "");
  host->hear(frame(0x001, "00000001 01 00 01 00"));
  EXPECT_EQ(host->state().trouble, "the ODrive reports error 0x01000000");
}

TEST(OdriveHost, a_sample_is_whole_with_its_last_answer_and_not_with_what_comes_unasked) {
  const auto host = find_motor_bus("odrive")->host(0);
  std::vector<BusFrame> frames;
  EXPECT_FALSE(host->hear(frame(0x009, "0000803f 00000000")));
  host->ask(AxisDemand::kTorque, 0.0, frames);
  EXPECT_FALSE(host->hear(frame(0x009, "0000803f 00000040")));
  EXPECT_FALSE(host->hear(frame(0x009, "00000040 00000000")));  // a cyclic one
  EXPECT_FALSE(host->hear(frame(0x014, "00000000 0000003f")));
  EXPECT_TRUE(host->hear(frame(0x017, "0000c041 00000000")));
  EXPECT_EQ(host->state().turns, 1.0);
  EXPECT_EQ(host->state().turns_s, 2.0);
  EXPECT_EQ(host->state().q_current_A, 0.5);
  EXPECT_EQ(host->state().bus_V, 24.0);
}

}  // namespace
}  // namespace omnihil::test
