// The guard around any firmware: a bad table is named, a bad drive never reaches the robot.
#include "firmware_iface/host_firmware.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "firmware_iface/reference/reference_firmware.h"
#include "tests/firmware_iface/reference/bench_robot.h"

namespace omnihil::test {
namespace {

// A firmware that gives the drive it was told to give.
struct Puppet {
  RobotDrive drive;
  RobotFeedback feedback;
  std::uint64_t last_us;
};
RobotDrive next_drive{};
RobotFeedback next_feedback{};
std::size_t claimed_frame_bytes = 0;
int init_code = 0;

omnihil_firmware_api puppet() {
  omnihil_firmware_api api{};
  api.abi_version = OMNIHIL_FIRMWARE_ABI;
  api.struct_bytes = sizeof(omnihil_firmware_api);
  api.name = "puppet";
  api.radio_format = nullptr;
  api.control_period_us = 2500;
  api.state_bytes = sizeof(Puppet);
  api.init = [](void*, const omnihil_robot_config*) { return init_code; };
  api.command = [](void* s, const omnihil_command*, std::uint64_t us) {
    static_cast<Puppet*>(s)->last_us = us;
  };
  api.radio_transmit = [](void*, std::uint8_t*, std::size_t) { return claimed_frame_bytes; };
  api.set_gains = [](void*, const omnihil_gains*) { return 1; };
  api.get_gains = [](const void*, omnihil_gains*) {};
  api.tick = [](void*, const omnihil_sensors*, omnihil_drive* drive) { *drive = next_drive; };
  api.feedback = [](const void*, omnihil_feedback* feedback) { *feedback = next_feedback; };
  return api;
}

RobotDrive full_drive(double duty) {
  RobotDrive drive{};
  for (int w = 0; w < kWheels; ++w) {
    drive.mode[w] = OMNIHIL_DRIVE_DUTY;
    drive.duty_ratio[w] = duty;
  }
  return drive;
}

const RobotConfig kConfig = geared_robot().config;

class HostFirmwareTest : public testing::Test {
 protected:
  void SetUp() override {
    next_drive = {};
    next_feedback = {};
    claimed_frame_bytes = 0;
    init_code = 0;
  }
  omnihil_firmware_api api = puppet();
};

TEST_F(HostFirmwareTest, PassesADriveWithinLimitsUnchanged) {
  HostFirmware firmware(&api, kConfig);
  for (const double duty : {1.0, -1.0, 0.0, 0.3}) {
    next_drive = full_drive(duty);
    next_drive.dribbler_ratio = 0.5;
    next_drive.kick = OMNIHIL_KICK_CHIP;
    next_drive.kick_pulse_s = 3e-3;
    const RobotDrive drive = firmware.tick({});
    EXPECT_EQ(std::memcmp(&drive, &next_drive, sizeof drive), 0);
  }
  EXPECT_EQ(firmware.faults(), FirmwareFaults{});
}

TEST_F(HostFirmwareTest, DutyThatIsNoNumberBecomesCoastOnThatWheelAlone) {
  HostFirmware firmware(&api, kConfig);
  for (const double bad :
       {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    next_drive = full_drive(0.3);
    next_drive.duty_ratio[2] = bad;
    const RobotDrive drive = firmware.tick({});
    EXPECT_EQ(drive.mode[2], static_cast<std::uint32_t>(OMNIHIL_DRIVE_COAST));
    EXPECT_EQ(drive.duty_ratio[2], 0.0);
    EXPECT_EQ(drive.mode[1], static_cast<std::uint32_t>(OMNIHIL_DRIVE_DUTY));
    EXPECT_EQ(drive.duty_ratio[1], 0.3);
  }
  EXPECT_EQ(firmware.faults().duty_not_finite, 3u);
  EXPECT_EQ(firmware.faults().total(), 3u);
}

TEST_F(HostFirmwareTest, DutyBeyondOneIsRefusedNotClamped) {
  HostFirmware firmware(&api, kConfig);
  for (const double bad : {1.0000001, -1.0000001, 1e300}) {
    next_drive = full_drive(0.3);
    next_drive.duty_ratio[0] = bad;
    EXPECT_EQ(firmware.tick({}).mode[0], static_cast<std::uint32_t>(OMNIHIL_DRIVE_COAST));
  }
  EXPECT_EQ(firmware.faults().duty_out_of_range, 3u);
  EXPECT_EQ(firmware.faults().total(), 3u);
}

TEST_F(HostFirmwareTest, EveryOtherBadRequestHasItsOwnCount) {
  HostFirmware firmware(&api, kConfig);
  next_drive = full_drive(0.1);
  next_drive.mode[1] = 7;
  next_drive.dribbler_ratio = 1.5;
  next_drive.kick = 9;
  RobotDrive drive = firmware.tick({});
  EXPECT_EQ(drive.mode[1], static_cast<std::uint32_t>(OMNIHIL_DRIVE_COAST));
  EXPECT_EQ(drive.dribbler_ratio, 0.0);
  EXPECT_EQ(drive.kick, static_cast<std::uint32_t>(OMNIHIL_KICK_NONE));
  next_drive = {};
  next_drive.kick_pulse_s = -1e-3;
  EXPECT_EQ(firmware.tick({}).kick_pulse_s, 0.0);
  EXPECT_EQ(firmware.faults().drive_mode_unknown, 1u);
  EXPECT_EQ(firmware.faults().dribbler_invalid, 1u);
  EXPECT_EQ(firmware.faults().kick_invalid, 2u);
  EXPECT_EQ(firmware.faults().total(), 4u);
}

TEST_F(HostFirmwareTest, FeedbackThatIsNoNumberIsZeroedAndCounted) {
  HostFirmware firmware(&api, kConfig);
  next_feedback.battery_V = std::nan("");
  next_feedback.omega_dribbler_rad_s = std::numeric_limits<double>::infinity();
  next_feedback.yaw_rad = 1.5;
  const RobotFeedback feedback = firmware.feedback();
  EXPECT_EQ(feedback.battery_V, 0.0);
  EXPECT_EQ(feedback.omega_dribbler_rad_s, 0.0);
  EXPECT_EQ(feedback.yaw_rad, 1.5);
  EXPECT_EQ(firmware.faults().feedback_not_finite, 2u);
}

TEST_F(HostFirmwareTest, FrameLongerThanItsBufferIsDropped) {
  HostFirmware firmware(&api, kConfig);
  std::uint8_t buffer[16];
  claimed_frame_bytes = 16;
  EXPECT_EQ(firmware.radio_transmit(buffer), 16u);
  claimed_frame_bytes = 17;
  EXPECT_EQ(firmware.radio_transmit(buffer), 0u);
  EXPECT_EQ(firmware.faults().frame_too_long, 1u);
}

TEST_F(HostFirmwareTest, TranslatesTimesAndNames) {
  HostFirmware firmware(&api, kConfig);
  EXPECT_EQ(firmware.name(), "puppet");
  EXPECT_EQ(firmware.radio_format(), "");
  EXPECT_EQ(firmware.control_period_ns(), 2'500'000);
  firmware.command({}, 1'234'567'890);
  Puppet state;
  const std::vector<std::byte> bytes = firmware.save();
  std::memcpy(&state, bytes.data(), sizeof state);
  EXPECT_EQ(state.last_us, 1'234'567u);
  EXPECT_FALSE(firmware.set_gains({}));
  firmware.radio_receive({}, 0);  // no radio of its own: nothing happens
}

TEST_F(HostFirmwareTest, StateBlockStartsZeroedAndAligned) {
  static bool zeroed = false, aligned = false;
  api.state_bytes = 1000;
  api.init = [](void* state, const omnihil_robot_config*) {
    const auto* bytes = static_cast<const unsigned char*>(state);
    zeroed = std::all_of(bytes, bytes + 1000, [](unsigned char byte) { return byte == 0; });
    aligned = reinterpret_cast<std::uintptr_t>(state) % 16 == 0;
    return 0;
  };
  HostFirmware firmware(&api, kConfig);
  EXPECT_TRUE(zeroed);
  EXPECT_TRUE(aligned);
}

TEST_F(HostFirmwareTest, RestoreTakesOnlyItsOwnSize) {
  HostFirmware firmware(&api, kConfig);
  std::vector<std::byte> bytes = firmware.save();
  EXPECT_TRUE(firmware.restore(bytes));
  bytes.pop_back();
  EXPECT_FALSE(firmware.restore(bytes));
}

std::string refusal_of(const omnihil_firmware_api* api, const RobotConfig& config = kConfig) {
  try {
    HostFirmware firmware(api, config);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST_F(HostFirmwareTest, EveryFaultOfTheTableIsNamed) {
  const std::pair<std::string, std::function<void(omnihil_firmware_api&)>> faults[] = {
      {"abi_version = 2", [](auto& a) { a.abi_version = 2; }},
      {"struct_bytes = 8", [](auto& a) { a.struct_bytes = 8; }},
      {"name is NULL", [](auto& a) { a.name = nullptr; }},
      {"control_period_us = 0", [](auto& a) { a.control_period_us = 0; }},
      {"control_period_us = 1000001", [](auto& a) { a.control_period_us = 1'000'001; }},
      {"state_bytes = 0", [](auto& a) { a.state_bytes = 0; }},
      {"init is NULL", [](auto& a) { a.init = nullptr; }},
      {"command is NULL", [](auto& a) { a.command = nullptr; }},
      {"set_gains is NULL", [](auto& a) { a.set_gains = nullptr; }},
      {"get_gains is NULL", [](auto& a) { a.get_gains = nullptr; }},
      {"tick is NULL", [](auto& a) { a.tick = nullptr; }},
      {"feedback is NULL", [](auto& a) { a.feedback = nullptr; }},
      {"radio_receive", [](auto& a) { a.radio_format = "some-format"; }},
  };
  for (const auto& [expected, spoil] : faults) {
    omnihil_firmware_api bad = puppet();
    spoil(bad);
    EXPECT_NE(refusal_of(&bad).find(expected), std::string::npos) << expected << "\n" << refusal_of(&bad);
  }
  EXPECT_NE(refusal_of(nullptr).find("NULL"), std::string::npos);
}

TEST_F(HostFirmwareTest, AllFaultsOfTheTableAreListedAtOnce) {
  api.tick = nullptr;
  api.feedback = nullptr;
  api.state_bytes = 0;
  EXPECT_EQ(check_firmware_api(&api).size(), 3u);
}

TEST_F(HostFirmwareTest, NewerTableWithMoreMembersIsAccepted) {
  api.struct_bytes = sizeof(omnihil_firmware_api) + 16;
  EXPECT_EQ(refusal_of(&api), "");
}

TEST_F(HostFirmwareTest, FirmwaresOwnRefusalIsReportedWithItsCode) {
  init_code = 42;
  EXPECT_NE(refusal_of(&api).find("'puppet' refused the configuration of robot 0 with code 42"),
            std::string::npos);
}

TEST(RobotConfigCheck, NamesEveryImpossibleFieldWithItsValue) {
  RobotConfig config = kConfig;
  config.wheel_radius_m = 0.0;
  config.gear_ratio = -3.0;
  config.motor_resistance_ohm = std::nan("");
  config.wheel_angle_rad[2] = std::numeric_limits<double>::infinity();
  config.command_timeout_s = -1.0;
  const std::vector<std::string> faults = check_robot_config(config);
  ASSERT_EQ(faults.size(), 5u);
  EXPECT_EQ(faults[0], "wheel_radius_m = 0: must be above 0");
  EXPECT_EQ(faults[1], "gear_ratio = -3: must be above 0");
  EXPECT_EQ(faults[2], "motor_resistance_ohm = nan: must be above 0");
  EXPECT_EQ(faults[3], "wheel_angle_rad[2] = inf: must be a number");
  EXPECT_EQ(faults[4], "command_timeout_s = -1: must be 0 (the firmware's own) to 3600");
  EXPECT_TRUE(check_robot_config(kConfig).empty());
}

TEST(ReferenceConfig, RefusesByCodeWhatTheHostWouldHaveRefused) {
  const omnihil_firmware_api* api = omnihil_reference_firmware();
  static reference_state state;
  const auto code = [&](const std::function<void(RobotConfig&)>& spoil) {
    RobotConfig config = kConfig;
    spoil(config);
    return api->init(&state, &config);
  };
  EXPECT_EQ(code([](RobotConfig&) {}), REFERENCE_CONFIG_OK);
  EXPECT_EQ(code([](RobotConfig& c) { c.gear_ratio = std::nan(""); }), REFERENCE_CONFIG_NOT_FINITE);
  EXPECT_EQ(code([](RobotConfig& c) { c.wheel_radius_m = 0; }), REFERENCE_CONFIG_NOT_POSITIVE);
  EXPECT_EQ(code([](RobotConfig& c) { c.command_timeout_s = -1; }), REFERENCE_CONFIG_TIMEOUT);
  EXPECT_EQ(code([](RobotConfig& c) { std::fill_n(c.wheel_angle_rad, 4, 0.5); }), REFERENCE_CONFIG_WHEELS);
}

TEST(ReferenceHost, WheelsThatCannotTurnTheRobotAreRefusedByName) {
  RobotConfig config = kConfig;
  std::fill_n(config.wheel_angle_rad, 4, 0.5);
  EXPECT_THROW(make_reference_firmware(config), std::invalid_argument);
}

TEST(ReferenceHost, SensorsThatAreNoNumbersNeverReachTheBridges) {
  Bench bench(geared_robot());
  bench.run_with(body_command(1, 0, 0), 500);
  for (int n = 0; n < 200; ++n) {
    if (n % 20 == 0) bench.send_body(1, 0, 0);
    RobotSensors sensors = bench.robot.sensors();
    sensors.bus_voltage_V = std::nan("");
    sensors.gyro_z_rad_s = std::numeric_limits<double>::infinity();
    sensors.accel_x_m_s2 = std::nan("");
    bench.drive = bench.firmware->tick(sensors);
    bench.robot.advance_1ms(bench.drive);
    bench.ms += 1;
  }
  EXPECT_EQ(bench.firmware->faults().total(), 0u);
  EXPECT_NEAR(bench.robot.body[0], 1.0, 0.02);
  EXPECT_TRUE(std::isfinite(bench.firmware->feedback().yaw_rad));
}

TEST(ReferenceHost, DeadEncoderLetsItsWheelGo) {
  Bench bench(geared_robot());
  bench.run_with(body_command(0.5, 0, 0), 500);
  RobotDrive drive{};
  for (int n = 0; n < 10; ++n) {
    RobotSensors sensors = bench.robot.sensors();
    sensors.encoder_counts[1] += n % 2 * 100'000'000;  // nonsense
    drive = bench.firmware->tick(sensors);
    bench.robot.advance_1ms(drive);
  }
  EXPECT_EQ(drive.mode[1], static_cast<std::uint32_t>(OMNIHIL_DRIVE_COAST));
  EXPECT_EQ(drive.mode[0], static_cast<std::uint32_t>(OMNIHIL_DRIVE_DUTY));
}

TEST(ReferenceHost, SupplySwitchedOffMeansBridgesOff) {
  Bench bench(geared_robot());
  bench.run_with(body_command(1, 0, 0), 100);
  bench.robot.bus_V = 0.2;
  bench.run_with(body_command(1, 0, 0), 1);
  EXPECT_TRUE(bench.coasting());
}

}  // namespace
}  // namespace omnihil::test
