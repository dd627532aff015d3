// The reference firmware on an ATmega328P per wheel: one chip per process, in lock-step with the plant.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "firmware_iface/host_firmware.h"
#include "firmware_iface/reference/wheel_node_firmware.h"
#include "hil/firmware/avr_board.h"
#include "hil/firmware/avr_firmware.h"
#include "hil/firmware/open_firmware.h"
#include "hil/loop/model_store.h"
#include "hil/loop/session_checks.h"
#include "hil/recording/session_setup.h"
#include "hil/scenario/scenario_run.h"
#include "hil/scenario/scenario_suite.h"
#include "protocols/radio_format.h"
#include "tests/hil/firmware/image_suite.h"

namespace omnihil {
namespace {
const std::string kImages = OMNIHIL_BUILD_DIR "/images/";
const std::string kImage = kImages + "omni_reference_avr.hex";
const std::string kBoard = OMNIHIL_SOURCE_DIR "/boards/omni_reference_avr.toml";
const std::vector<std::string> kModels = {OMNIHIL_SOURCE_DIR "/models"};
constexpr int kRobot = 5;
constexpr double kDeadline_s = 60.0;

SessionConfig one_robot() {
  SessionSetup setup;
  setup.model = load_robot_model("omni_1024", kModels).bundle;
  setup.radio_format = "ulaval-hermes";
  setup.robot_ids = {kRobot};
  setup.plant.physics = Physics::kPlanar;
  return session_config(setup);
}

SuiteOptions options(const std::string& image = kImage) {
  SuiteOptions o;
  o.firmware.file = image;
  o.firmware.board = kBoard;
  o.firmware.deadline_s = kDeadline_s;
  o.robot = "omni_1024";
  o.model_folders = kModels;
  return o;
}

struct AvrImages : testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(OMNIHIL_BUILD_DIR "/tools/omnihil-avr"))
      GTEST_SKIP() << "no simavr: omnihil-avr was not built";
    if (!std::filesystem::exists(kImage)) GTEST_SKIP() << "no avr-gcc: the image was not built";
  }
};

ImageDrive drive(const std::string& image, const Session::FirmwareMaker& make = {}) {
  Session session(one_robot(), make ? make : avr_firmware(image, kBoard, kDeadline_s));
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.omega_body_rad_s = 8.0;
  return drive_by_radio(session, command, kRobot, 250);
}

TEST_F(AvrImages, DriveByRadioFromHexAndElfAlikeAndTwoRunsHaveOneHash) {
  const ImageDrive hex = drive(kImage), elf = drive(kImages + "omni_reference_avr.elf");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_GT(hex.truth.omega_rotor_rad_s[i], 20.0);
  EXPECT_EQ(hex.failure, "");
  EXPECT_EQ(hex.missed, 0u);
  EXPECT_EQ(hex.hash, elf.hash);
}

TEST_F(AvrImages, AnswerThePingOnceAsTheRobotThatTheirSwitchesSay) {
  Session session(one_robot(), avr_firmware(kImage, kBoard, kDeadline_s));
  std::vector<std::uint8_t> out;
  for (int step = 0; step < 60; ++step) {
    // COBS of 01 FE robot 00 sum: a ping; the answer 01 robot 00 01 sum
    const std::vector<std::uint8_t> ping{4, 1, 0xFE, kRobot, 2, 1 + 0xFE + kRobot - 256, 0};
    session.step(step == 20 ? std::span<const std::uint8_t>(ping) : std::span<const std::uint8_t>{}, out);
  }
  EXPECT_EQ(out, (std::vector<std::uint8_t>{3, 1, kRobot, 3, 1, 1 + kRobot + 1, 0}));
}

TEST_F(AvrImages, AHangIsEndedByTheWatchdogAndItsLostPeriodsAreCounted) {
  const ImageDrive hung = drive(kImages + "avr_hangs.hex");
  EXPECT_EQ(hung.failure, "");
  ASSERT_FALSE(hung.report.empty());
  int resets = 0;
  for (const std::string& line : hung.report)
    resets += line.find("reset by the watchdog at 0.2") != std::string::npos;
  EXPECT_EQ(resets, kWheels);       // 0.2 s and 16 ms, each board once
  EXPECT_GE(hung.missed, 4u * 7u);  // 16 ms of 2 ms each
}

TEST_F(AvrImages, AChipThatStopsIsTheFirmwaresFailureAndItsWheelCoasts) {
  const ImageDrive stopped = drive(kImages + "avr_runs_away.hex");
  EXPECT_NE(stopped.failure.find("board of wheel 0: stopped at pc 0x"), std::string::npos) << stopped.failure;
}

TEST_F(AvrImages, SlowWheelLevelPartOfTheShippedSuitePasses) {
  const SuiteReading suite = read_suite({kSuite}, "wheel");
  ASSERT_GE(suite.scenarios.size(), 9u);
  for (const Scenario& s : suite.scenarios) {
    for (const CheckResult& r : run_one(s, options()).results) {
      EXPECT_TRUE(r.passed) << s.file << ": " << failure_line(r);
    }
  }
}

class SlowBrokenAvrImage : public AvrImages, public testing::WithParamInterface<BrokenImage> {};

TEST_P(SlowBrokenAvrImage, FailsTheMatchingCheckAlone) {
  expect_only_its_check_fails(options(kImages + "avr_" + GetParam().image + ".hex"), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Images, SlowBrokenAvrImage, testing::ValuesIn(kBrokenImages),
                         [](const auto& of) { return std::string(of.param.image); });

// rms of the difference over rms of the speed, wheel by wheel, at the instants that both have.
double relative_difference(const ScenarioTrace& slow, const ScenarioTrace& fast, std::size_t wheel) {
  const auto a = slow.column("omega_wheel_rad_s", wheel), b = fast.column("omega_wheel_rad_s", wheel);
  const std::size_t stride = (b.size() + a.size() / 2) / a.size();
  if (b.size() <= stride * (a.size() - 1)) return INFINITY;
  double off = 0.0, all = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(slow.time_s()[i], fast.time_s()[stride * i], 1e-9);
    off += (a[i] - b[stride * i]) * (a[i] - b[stride * i]);
    all += a[i] * a[i];
  }
  return std::sqrt(off / all);
}

TEST_F(AvrImages, SlowHostBuildAndImageGiveTheSameWheelSpeedsWithinOnePercent) {
  const auto nodes = [](const RobotConfig& config) -> std::unique_ptr<Firmware> {
    return std::make_unique<HostFirmware>(omnihil_wheel_node_firmware(), config);
  };
  for (const char* name : {"wheel/speed_step.toml", "wheel/brown_out.toml"}) {
    const Scenario s = shipped_scenario(name);
    const SessionConfig config = one_robot();
    const ScenarioRun host = run_scenario(s, config, nodes),
                      whole = run_scenario(s, config, open_firmware({}, config));
    const ScenarioRun image = run_scenario(s, config, avr_firmware(kImage, kBoard, kDeadline_s));
    EXPECT_EQ(image.commands, host.commands);
    for (std::size_t w = 0; w < kWheels; ++w) {
      const double off = relative_difference(host.trace, image.trace, w);
      EXPECT_LE(off, 0.01) << name << " wheel " << w;
      RecordProperty(std::string(name) + " wheel " + std::to_string(w), std::to_string(off));
      RecordProperty(std::string(name) + " wheel " + std::to_string(w) + " four-wheel firmware",
                     std::to_string(relative_difference(whole.trace, image.trace, w)));
    }
  }
}

// 200 of 800 steps; a shaft at 100 rad/s has 1024 * 100 / 2 pi edges a second, and the count is sent every 2
// ms.
TEST_F(AvrImages, A32u4CountsEveryEdgeAndItsDutyIsThatOfItsRegisters) {
  const char* const board_text = R"(format = "omnihil-board/1"
name = "32U4"
chip = "atmega32u4"
control_interrupt = "TIMER0_COMPA"
control_period_us = 2000
[[motor]]
wheel = 3
pwm = "OC1A"
direction = "PB4"
encoder = ["PD0", "PD1"]
[radio]
format = "ulaval-hermes"
via = "USART1"
)";
  std::vector<mcu::BoardProblem> problems;
  const auto spec = mcu::read_avr_board(board_text, "32u4", problems);
  ASSERT_TRUE(spec.has_value()) << problems.at(0).text();
  std::ifstream file(kImages + "avr_counts_32u4.elf", std::ios::binary);
  const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(file)), {});
  mcu::AvrImage image;
  std::vector<std::string> why;
  ASSERT_TRUE(mcu::read_avr_image(bytes, image, why));
  AvrBoard board(*spec, spec->motors.at(0), image, robot_config(one_robot().robots.at(0), kRobot),
                 kDeadline_s);
  constexpr double kOmega_rad_s = 100.0, kCounts = 1024.0, kTwoPi = 6.283185307179586;
  mcu::WorldState world;
  world.omega_rotor_rad_s[3] = kOmega_rad_s;
  for (int step = 0; step < 21; ++step) {
    world.at_ns = step * 500'000;
    world.theta_rotor_rad[3] = kOmega_rad_s * 1e-9 * static_cast<double>(world.at_ns);
    board.begin(world, world.at_ns + 500'000);
    board.finish();
  }
  EXPECT_TRUE(board.drive().driven);
  EXPECT_NEAR(board.drive().duty_ratio, 200.0 / 800.0, 1e-12);
  EXPECT_EQ(board.missed_control_periods(), 0u);
  ASSERT_EQ(board.sent().size(), 5u);  // at 2, 4, 6, 8 and 10 ms
  for (std::size_t i = 0; i < 5; ++i) {
    const double edges = kOmega_rad_s * kCounts / kTwoPi * 2e-3 * static_cast<double>(i + 1);
    EXPECT_NEAR(board.sent()[i].at(0), edges, 1.0) << i;
  }
}

TEST_F(AvrImages, EepromPageInTheBoardFileIsTheRobotOfItsModel) {
  std::ifstream file(kBoard);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  std::vector<mcu::BoardProblem> problems;
  const auto board = mcu::read_avr_board(text, kBoard, problems);
  ASSERT_TRUE(board.has_value());
  ASSERT_EQ(board->eeprom.size(), 1u);
  const RobotConfig c = robot_config(one_robot().robots.at(0), kRobot);
  std::vector<std::uint32_t> expected{0x494E4D4F};
  for (const double value : {c.wheel_angle_rad[0], c.wheel_angle_rad[1], c.wheel_angle_rad[2],
                             c.wheel_angle_rad[3], c.wheel_radius_m, c.wheel_center_radius_m, c.gear_ratio,
                             c.encoder_counts_per_rotor_turn, c.bus_voltage_nominal_V, c.motor_resistance_ohm,
                             c.motor_torque_constant_Nm_per_A, c.command_timeout_s}) {
    expected.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  }
  EXPECT_EQ(board->eeprom[0].words, expected);
}

}  // namespace
}  // namespace omnihil
