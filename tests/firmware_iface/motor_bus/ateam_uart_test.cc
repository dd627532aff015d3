// SSL A-Team motor UARTs of 2025 and 2026: bytes by the layout, against packets of the team's own code, the
// loop.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/firmware_iface/motor_bus/bus_harness.h"

namespace omnihil::test {
namespace {

enum Kind : std::uint8_t { kOpenLoop = 0, kVelocity = 1, kTorque = 2 };

BusFrame motion_2025(std::uint32_t line, std::uint8_t flags, std::uint8_t kind, double setpoint) {
  BusFrame f = can_frame(line, 52);
  f.data[0] = 0x21;
  f.data[8] = flags;
  f.data[12] = kind;
  put_f32(f, 16, setpoint);
  return f;
}
BusFrame motion_2026(std::uint32_t line, std::uint8_t flags, std::uint8_t kind, std::int16_t mA,
                     double setpoint) {
  BusFrame f = can_frame(line, 20);
  f.data[0] = 0x21;
  f.data[8] = flags;
  f.data[12] = kind;
  put_u16(f, 14, static_cast<std::uint16_t>(mA));
  put_f32(f, 16, setpoint);
  return f;
}
double omega(const BusRig& rig, std::size_t w) { return rig.session->plant().truth(0).omega_rotor_rad_s[w]; }

TEST(AteamUart2025Test, a_commanded_speed_is_reached_in_the_plant_and_told) {
  BusRig rig("ateam-uart-2025");
  rig.run_ms(1500, [&] {
    for (std::uint32_t m = 0; m < 4; ++m) rig.send(motion_2025(m, 2, kVelocity, 30.0));
  });
  for (std::size_t w = 0; w < kWheels; ++w) EXPECT_NEAR(omega(rig, w), 30.0, 0.02 * 30.0) << w;
  const BusFrame reply = rig.wire->last(3);
  ASSERT_EQ(reply.size, 56);
  EXPECT_EQ(reply.data[0], 0x81);
  EXPECT_EQ(get_f32(reply, 12), 30.0F);
  EXPECT_NEAR(get_f32(reply, 24), 30.0, 0.02 * 30.0);
  EXPECT_EQ(static_cast<std::int32_t>(get_u32(reply, 20)), static_cast<int>(get_f32(reply, 24)));
}

TEST(AteamUart2025Test, telemetry_comes_every_5_ms_and_only_while_it_is_on) {
  BusRig rig("ateam-uart-2025");
  rig.send(motion_2025(1, 2, kOpenLoop, 0.0));
  rig.run_ms(100);
  EXPECT_EQ(rig.wire->from_motors.size(), 100U / 5);
  rig.send(motion_2025(1, 0, kOpenLoop, 0.0));
  rig.run_ms(1);
  rig.wire->from_motors.clear();
  rig.run_ms(50);
  EXPECT_TRUE(rig.wire->from_motors.empty());
}

TEST(AteamUart2025Test, a_command_older_than_100_ms_opens_the_bridge) {
  BusRig rig("ateam-uart-2025");
  rig.run_ms(300, [&] { rig.send(motion_2025(0, 0, kVelocity, 30.0)); });
  rig.run_ms(95);
  EXPECT_NE(rig.firmware->feedback().duty_ratio[0], 0.0);
  rig.run_ms(10);
  EXPECT_EQ(rig.firmware->feedback().duty_ratio[0], 0.0);
  EXPECT_EQ(rig.firmware->timeouts(), 1U);
}

TEST(AteamUart2025Test, wrong_sizes_types_and_values_are_counted_and_move_nothing) {
  BusRig rig("ateam-uart-2025");
  BusFrame shorter = motion_2025(0, 0, kVelocity, 30.0);
  shorter.size = 51;
  BusFrame unknown = motion_2025(0, 0, kVelocity, 30.0);
  unknown.data[0] = 0x22;
  rig.send(shorter);
  rig.send(unknown);
  rig.send(motion_2025(0, 0, 4, 30.0));
  rig.send(motion_2025(0, 0, kVelocity, std::nan("")));
  rig.run_ms(50);
  EXPECT_EQ(rig.count(BusVerdict::kLength), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kUnknownCommand), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kUnsupported), 1U);
  EXPECT_EQ(rig.count(BusVerdict::kNotFinite), 1U);
  EXPECT_EQ(omega(rig, 0), 0.0);
}

nlohmann::json vectors(const std::string& file) {
  const char* shared = std::getenv("OMNIHIL_SHARED");
  if (shared == nullptr) return {};
  std::ifstream in(std::string(shared) + "/vectors/" + file);
  return in ? nlohmann::json::parse(in) : nlohmann::json{};
}

TEST(AteamUart2025Test, the_teams_own_parameter_packets_come_back_as_they_were_written) {
  const nlohmann::json all = vectors("ateam-rnp-stspin-2025.json");
  if (all.is_null()) GTEST_SKIP() << "OMNIHIL_SHARED is not set, or has no ateam-rnp-stspin-2025.json";
  int seen = 0;
  for (const auto& row : all["vectors"]["uart_motor_command_params"]) {
    BusRig rig("ateam-uart-2025");
    BusFrame command = frame(0, row["bytes"].get<std::string>());
    ASSERT_EQ(command.size, 52);
    put_u32(command, 8, 0x3FF);  // write all of it
    rig.send(command);
    rig.run_ms(1);
    const BusFrame reply = rig.wire->last(0);
    if (rig.count(BusVerdict::kNotFinite) == 1) continue;
    ASSERT_EQ(reply.size, 56);
    EXPECT_EQ(get_u32(reply, 12), row["timestamp"].get<std::uint32_t>());
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(get_f32(reply, 16 + 4 * i), row["vel_pid_imax"][i].get<float>());
      EXPECT_EQ(get_f32(reply, 32 + 4 * i), row["cur_pid_imax"][i].get<float>());
    }
    EXPECT_EQ(get_u16(reply, 48), row["cur_clamp"].get<std::uint16_t>());
    ++seen;
  }
  EXPECT_GT(seen, 5);
}

// The same with numbers of our own: what is not to be written stays, and is told.
TEST(AteamUart2025Test, parameters_are_written_where_the_mask_says_and_told) {
  BusRig rig("ateam-uart-2025");
  BusFrame command = can_frame(2, 52);
  command.data[0] = 0x20;
  put_u32(command, 8, 1U << 0 | 1U << 1 | 1U << 8 | 1U << 9);  // time, velocity p, current i_max, clamp
  put_u32(command, 12, 1'700'000'000);
  for (std::size_t i = 0; i < 8; ++i) put_f32(command, 16 + 4 * i, 0.5 + static_cast<double>(i));
  put_u16(command, 48, 4321);
  rig.send(command);
  rig.run_ms(1);
  const BusFrame reply = rig.wire->last(2);
  ASSERT_EQ(reply.size, 56);
  EXPECT_EQ(reply.data[0], 0x80);
  EXPECT_EQ(get_u32(reply, 12), 1'700'000'000U);
  EXPECT_EQ(get_f32(reply, 16), 0.5F);
  EXPECT_EQ(get_f32(reply, 20), 8.0F);  // the firmware's own velocity i
  EXPECT_EQ(get_f32(reply, 44), 7.5F);
  EXPECT_EQ(get_u16(reply, 48), 4321);
}

// The fit of its duty: 2 (0.00144873 w -+ 0.0057431) from 4 rad/s on.
TEST(AteamUart2025Test, open_loop_duty_is_linear_beyond_its_dead_band) {
  for (const double omega_rad_s : {0.0, 3.9, -3.9, 4.0, 50.0, -50.0, 400.0}) {
    BusRig rig("ateam-uart-2025");
    rig.send(motion_2025(0, 2, kOpenLoop, omega_rad_s));
    rig.run_ms(6);
    const double sign = omega_rad_s < 0.0 ? -1.0 : 1.0;
    const double duty = 2.0 * (0.00144873 * std::abs(omega_rad_s) - 0.0057431);
    const double expected = std::abs(omega_rad_s) < 4.0 ? 0.0 : sign * std::min(1.0, duty);
    EXPECT_NEAR(get_f32(rig.wire->last(0), 32), expected, 1e-6) << omega_rad_s;
  }
}

TEST(AteamUart2025Test, open_loop_duty_is_that_of_the_running_binary) {
  const nlohmann::json all = vectors("ateam-wheel-firmware-io.json");
  if (all.is_null()) GTEST_SKIP() << "OMNIHIL_SHARED is not set, or has no ateam-wheel-firmware-io.json";
  int seen = 0;
  for (const auto& row : all["open_loop"]) {
    if (row["hall"] != 1) continue;
    BusRig rig("ateam-uart-2025");
    rig.send(motion_2025(0, 2, kOpenLoop, row["setpoint"].get<double>()));
    rig.run_ms(6);
    EXPECT_NEAR(get_f32(rig.wire->last(0), 32), row["reported_vel_computed_setpoint"].get<double>(), 1e-6)
        << row["setpoint"];
    ++seen;
  }
  EXPECT_GT(seen, 5);
}

TEST(AteamUart2026Test, a_commanded_speed_is_reached_and_told) {
  BusRig rig("ateam-uart-2026");
  rig.run_ms(1500, [&] {
    for (std::uint32_t m = 0; m < 4; ++m) rig.send(motion_2026(m, 2 | 4, 4, 0, 30.0));
  });
  for (std::size_t w = 0; w < kWheels; ++w) EXPECT_NEAR(omega(rig, w), 30.0, 0.02 * 30.0) << w;
  const BusFrame reply = rig.wire->last(2);
  ASSERT_EQ(reply.size, 68);
  EXPECT_EQ(reply.data[0], 0x81);
  EXPECT_EQ(reply.data[10], 4);
  EXPECT_NEAR(get_u16(reply, 12), 1000.0 * rig.session->config().robots[0].bus_voltage_V, 10.0);
  EXPECT_NEAR(get_i16(reply, 18), 300.0, 0.02 * 300.0);  // 0.1 rad/s
  EXPECT_EQ(get_f32(reply, 60), 30.0F);
}

TEST(AteamUart2026Test, without_enable_nothing_moves) {
  BusRig rig("ateam-uart-2026");
  rig.run_ms(200, [&] { rig.send(motion_2026(0, 2, 4, 0, 30.0)); });
  EXPECT_EQ(omega(rig, 0), 0.0);
}

TEST(AteamUart2026Test, current_and_voltage_reach_the_bridge) {
  BusRig rig("ateam-uart-2026");
  rig.run_ms(60, [&] { rig.send(motion_2026(0, 2 | 4, 3, 500, 0.0)); });
  EXPECT_NEAR(get_i16(rig.wire->last(0), 20), 500, 50);  // mA
  rig.run_ms(5, [&] { rig.send(motion_2026(0, 2 | 4, 2, 0, 3.0)); });
  EXPECT_NEAR(rig.firmware->feedback().duty_ratio[0] * rig.session->config().robots[0].bus_voltage_V, 3.0,
              0.05);
}

TEST(AteamUart2026Test, parameters_are_written_and_read_back) {
  BusRig rig("ateam-uart-2026");
  rig.send(frame(1, "20000000 00000000 01010000 0000a040 00000000"));  // write I = 5.0f
  rig.send(frame(1, "20000000 00000000 01000000 00000000 00000000"));  // read it
  rig.run_ms(1);
  const BusFrame reply = rig.wire->last(1);
  EXPECT_EQ(reply.data[0], 0x80);
  EXPECT_EQ(reply.data[10], 1);
  EXPECT_EQ(get_f32(reply, 12), 5.0F);
}

}  // namespace
}  // namespace omnihil::test
