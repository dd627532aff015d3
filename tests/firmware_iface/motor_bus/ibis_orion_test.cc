// ibis-ssl Orion BLDC boards on CAN: ids and bytes, the voltage law, stale set-points, the FIFO that nobody
// reads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/firmware_iface/mcu/board/dialects_for_tests.h"
#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

constexpr double kTwoPi = 6.283185307179586;
const char* const kFive = "0000a040 00000000";  // 5.0f rev/s

void command_all(BusRig& rig, const char* data) {
  for (std::uint32_t m = 0; m < 4; ++m) rig.send(frame(0x100 + m, data));
}
double k(const BusRig& rig) { return rig.session->config().robots[0].motor.torque_constant_Nm_per_A; }

TEST(IbisOrionTest, speed_and_angle_come_every_millisecond_the_rest_every_sixteen) {
  BusRig rig("ibis-orion");
  rig.run_ms(160);
  int fast = 0, battery = 0;
  for (const BusFrame& f : rig.wire->from_motors) {
    fast += f.id == 0x202;
    battery += f.id == 0x211;
  }
  EXPECT_EQ(fast, 160);
  EXPECT_EQ(battery, 160 / 16);
  const BusFrame volts = rig.wire->last(0x211);
  EXPECT_NEAR(get_f32(volts, 0), rig.session->config().robots[0].bus_voltage_V, 0.01);
}

TEST(IbisOrionTest, rev_s_per_volt_is_that_of_the_unloaded_motor) {
  BusRig rig("ibis-orion");
  rig.run_ms(20);
  EXPECT_NEAR(get_f32(rig.wire->last(0x502), 0), 1.0 / (kTwoPi * k(rig)), 1e-4);
}

// No speed loop: what is reached is V/k less what friction costs, so short of the set-point, never beyond it.
TEST(IbisOrionTest, the_set_point_is_a_voltage_and_friction_keeps_it_short) {
  BusRig rig("ibis-orion");
  rig.run_ms(2000, [&] { command_all(rig, kFive); });
  for (std::size_t w = 0; w < kWheels; ++w) {
    EXPECT_GT(rig.rotor_turns_s(w), 0.6 * 5.0);
    EXPECT_LT(rig.rotor_turns_s(w), 5.0);
  }
  const BusFrame told = rig.wire->last(0x200);
  EXPECT_NEAR(get_f32(told, 0), rig.rotor_turns_s(0), 0.05);
  EXPECT_TRUE(get_f32(told, 4) >= 0.0F && get_f32(told, 4) <= 6.3F);
}

TEST(IbisOrionTest, the_voltage_stays_within_six_volts_of_the_back_emf) {
  BusRig rig("ibis-orion");
  rig.run_ms(2);
  command_all(rig, "0000a042 00000000");  // 80.0f rev/s at once
  rig.run_ms(1);
  const double bus_V = rig.session->config().robots[0].bus_voltage_V;
  EXPECT_NEAR(rig.firmware->feedback().duty_ratio[0] * bus_V, 6.0, 0.5);
}

TEST(IbisOrionTest, a_set_point_goes_stale_after_100_ms) {
  BusRig rig("ibis-orion");
  rig.run_ms(500, [&] { command_all(rig, kFive); });
  rig.run_ms(95);
  EXPECT_EQ(rig.firmware->timeouts(), 0U);
  rig.run_ms(1000);
  EXPECT_EQ(rig.firmware->timeouts(), 4U);
  EXPECT_LT(std::abs(rig.rotor_turns_s(0)), 0.05);
}

TEST(IbisOrionTest, a_lone_frame_of_the_first_motor_is_never_read) {
  BusRig rig("ibis-orion");
  rig.run_ms(300, [&] { rig.send(frame(0x100, kFive)); });
  EXPECT_EQ(rig.rotor_turns_s(0), 0.0);
  rig.run_ms(300, [&] {
    rig.send(frame(0x100, kFive));
    rig.send(frame(0x101, "00000000 00000000"));
  });
  EXPECT_GT(rig.rotor_turns_s(0), 0.5);
}

TEST(IbisOrionTest, free_wheel_and_emergency_stop_open_the_bridges) {
  BusRig rig("ibis-orion");
  rig.run_ms(300, [&] { command_all(rig, kFive); });
  rig.send(frame(0x110, "03 00 0a 00 00 00 00 00"));  // free for 10 ms
  rig.run_ms(5, [&] { command_all(rig, kFive); });
  EXPECT_EQ(rig.firmware->feedback().duty_ratio[1], 0.0);
  rig.run_ms(10, [&] { command_all(rig, kFive); });
  EXPECT_NE(rig.firmware->feedback().duty_ratio[1], 0.0);
  rig.send(frame(0x000, "01 00 00 00 00 00 00 00"));
  rig.run_ms(10, [&] { command_all(rig, kFive); });
  EXPECT_EQ(rig.firmware->feedback().duty_ratio[1], 0.0);
  rig.send(frame(0x010, "00 00"));
  rig.run_ms(10, [&] { command_all(rig, kFive); });
  EXPECT_NE(rig.firmware->feedback().duty_ratio[1], 0.0);
}

// What the unmodified firmware took and sent in an emulator.
nlohmann::json firmware_io() {
  const char* shared = std::getenv("OMNIHIL_SHARED");
  if (shared == nullptr) return {};
  std::ifstream in(std::string(shared) + "/vectors/ibis-f303-firmware-io.json");
  return in ? nlohmann::json::parse(in) : nlohmann::json{};
}
constexpr const char* kNoFile = "OMNIHIL_SHARED is not set, or has no ibis-f303-firmware-io.json";
bool is_angle(float rad) {
  const double steps = rad * 65535.0 / kTwoPi;
  return static_cast<float>(std::round(steps) * kTwoPi / 65535.0) == rad;
}

TEST(IbisOrionTest, the_main_board_says_set_points_in_the_bytes_that_the_firmware_took) {
  const nlohmann::json all = firmware_io();
  if (all.is_null()) GTEST_SKIP() << kNoFile;
  int frames = 0;
  const WheelWords words = mcu::dialect_words("ibis-orion-can", 2);
  for (const auto& row : all.at("rows")) {
    std::vector<double> omega_rad_s;
    for (const double rev_s : row.at("cmd_rps")) omega_rad_s.push_back(rev_s * kTwoPi);
    std::vector<BusFrame> said;
    speak(words, {}, omega_rad_s, said);
    ASSERT_EQ(said.size(), row.at("can_in").size());
    for (std::size_t i = 0; i < said.size(); ++i, ++frames) {
      EXPECT_EQ(said[i].id, row.at("can_in")[i].at("id"));
      EXPECT_EQ(data_of(said[i]), hex(row.at("can_in")[i].at("data").get<std::string>())) << row;
    }
  }
  EXPECT_EQ(frames, 64);
}

TEST(IbisOrionTest, its_frames_have_the_ids_and_the_form_of_those_of_the_firmware) {
  const nlohmann::json all = firmware_io();
  if (all.is_null()) GTEST_SKIP() << kNoFile;
  BusRig rig("ibis-orion");
  rig.run_ms(500, [&] { command_all(rig, kFive); });
  std::set<std::uint32_t> ours, theirs;
  const auto expect_form = [](std::uint32_t id, float second) {
    EXPECT_TRUE(id >= 0x210 || is_angle(second)) << id << " " << second;
    EXPECT_TRUE(id < 0x210 || id / 16 == 0x22 || second == 0.0F) << id << " " << second;
  };
  for (const BusFrame& f : rig.wire->from_motors) {
    if (f.id % 16 > 1) continue;  // the other board's
    ASSERT_EQ(f.size, 8);
    ours.insert(f.id);
    expect_form(f.id, get_f32(f, 4));
  }
  for (const auto& each : all.at("telemetry").at("frames")) {
    const BusFrame f = frame(each.at("id"), each.at("data").get<std::string>());
    ASSERT_EQ(f.size, 8);
    EXPECT_EQ(get_f32(f, 0), each.at("f32")[0].get<float>());
    theirs.insert(f.id);
    expect_form(f.id, get_f32(f, 4));
  }
  // Battery, temperatures and rev/s per V are the board's; here each motor says them.
  for (const std::uint32_t id : theirs) EXPECT_TRUE(ours.contains(id)) << id;
  for (const std::uint32_t id : ours) EXPECT_TRUE(theirs.contains(id) || theirs.contains(id - 1)) << id;
}

TEST(IbisOrionTest, bad_frames_are_counted_by_cause) {
  BusRig rig("ibis-orion");
  rig.send(frame(0x101, "0000c07f 00000000"));  // NaN
  rig.send(frame(0x101, "0000"));
  rig.send(fd_frame(0x101, kFive));
  rig.send(frame(0x310, ""));     // calibration
  rig.send(frame(0x104, kFive));  // the dribbler's
  rig.run_ms(50);
  EXPECT_EQ(rig.count(BusVerdict::kNotFinite), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kLength), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kWrongKind), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kUnsupported), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kNotOurs), 1U);
  EXPECT_EQ(rig.rotor_turns_s(1), 0.0);
}

}  // namespace
}  // namespace omnihil::test
