// The reference firmware as an image for its board: the same sources as the host build, the same behaviour.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "firmware_iface/mcu/board/mcu_firmware.h"
#include "hil/firmware/image_firmware.h"
#include "hil/loop/model_store.h"
#include "hil/loop/session_checks.h"
#include "hil/recording/session_setup.h"
#include "hil/scenario/scenario_run.h"
#include "hil/scenario/scenario_suite.h"
#include "protocols/radio_format.h"
#include "tests/hil/firmware/image_suite.h"

namespace omnihil {
namespace {
const std::string kImage = OMNIHIL_BUILD_DIR "/images/omni_reference_f405.elf";
const std::string kBoard = OMNIHIL_SOURCE_DIR "/boards/omni_reference_f405.toml";
const std::vector<std::string> kModels = {OMNIHIL_SOURCE_DIR "/models"};
constexpr int kRobot = 1;
constexpr std::uint32_t kPage = 0x08060000;

SessionConfig one_robot() {
  SessionSetup setup;
  setup.model = load_robot_model("omni_default", kModels).bundle;
  setup.radio_format = "ulaval-hermes";
  setup.robot_ids = {kRobot};
  setup.plant.physics = Physics::kPlanar;
  return session_config(setup);
}

SuiteOptions options(bool image) {
  SuiteOptions o;
  if (image) o.firmware.file = kImage, o.firmware.board = kBoard;
  o.model_folders = kModels;
  return o;
}

struct ReferenceImage : testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(kImage)) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
  }
};

ImageDrive drive(const std::string& image = kImage) {
  Session session(one_robot(), image_firmware(image, kBoard));
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = 0.5;
  return drive_by_radio(session, command, kRobot, 300);
}

TEST_F(ReferenceImage, BootsDrivesByRadioAndUsesNothingThatIsNotModelled) {
  const ImageDrive once = drive();
  EXPECT_LT(once.truth.omega_rotor_rad_s[0], -5.0);  // the front left wheel turns backward
  EXPECT_EQ(once.report, std::vector<std::string>{});
}

TEST_F(ReferenceImage, AnswersOverTheRadioAsTheRobotThatItsSwitchesSay) {
  SessionConfig config = one_robot();
  config.robots.push_back(config.robots[0]);
  config.robot_ids = {kRobot, 5};
  Session session(config, image_firmware(kImage, kBoard));
  std::vector<std::uint8_t> out;
  for (int step = 0; step < 50; ++step) {
    // COBS of 01 FE robot 00 sum: a ping; the answer 01 robot 00 01 sum
    const std::vector<std::uint8_t> ping{4, 1, 0xFE, 5, 2, 1 + 0xFE + 5 - 256, 0};
    session.step(step == 10 ? std::span<const std::uint8_t>(ping) : std::span<const std::uint8_t>{}, out);
  }
  EXPECT_EQ(out, (std::vector<std::uint8_t>{3, 1, 5, 3, 1, 1 + 5 + 1, 0}));
}

TEST_F(ReferenceImage, WatchdogEndsAHangAfterTwentyMilliseconds) {
  const ImageDrive hung = drive(OMNIHIL_BUILD_DIR "/images/reference_hangs.elf");
  ASSERT_EQ(hung.report.size(), 1u);  // 0.2 s and 20 ms, and not a second time within 0.3 s
  EXPECT_NE(hung.report[0].find("reset by"), std::string::npos) << hung.report[0];
  EXPECT_NE(hung.report[0].find("at 0.2"), std::string::npos) << hung.report[0];
}

TEST_F(ReferenceImage, ControlInterruptTakesLessThanHalfAPeriodAndTheCoreSleepsOtherwise) {
  std::ifstream elf_file(kImage, std::ios::binary), board_file(kBoard);
  const std::string bytes((std::istreambuf_iterator<char>(elf_file)), {});
  const std::string text((std::istreambuf_iterator<char>(board_file)), {});
  mcu::ElfImage elf;
  std::vector<std::string> broken;
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  ASSERT_TRUE(mcu::read_elf(std::span(data, bytes.size()), elf, broken));
  std::vector<mcu::BoardProblem> problems;
  mcu::McuFirmware firmware(*mcu::read_board(text, kBoard, problems), elf,
                            robot_config(one_robot().robots.at(0), kRobot));
  RobotCommand command{};
  command.mode = OMNIHIL_MODE_BODY_VELOCITY;
  command.v_forward_m_s = 0.5;
  std::vector<std::uint8_t> frame;
  find_radio_format("ulaval-hermes")->encode_command(command, {.robot_id = kRobot}, frame);
  RobotSensors sensors{};
  sensors.bus_voltage_V = 22.2;
  for (int tick = 0; tick < 1000; ++tick, sensors.now_us += 500) {
    if (tick % 20 == 0) firmware.radio_receive(frame, static_cast<std::int64_t>(sensors.now_us) * 1000);
    firmware.tick(sensors);
  }
  constexpr int kTim6 = 16 + 54;
  constexpr double kCore_Hz = 168e6, kHalfPeriod_s = 0.5e-3;
  const mcu::MachineReport report = firmware.board().machine().report();
  const mcu::InterruptLoad& control = report.exceptions.at(kTim6);
  EXPECT_NEAR(static_cast<double>(control.count), 500.0, 1.0);
  EXPECT_LT(static_cast<double>(control.longest) / kCore_Hz, kHalfPeriod_s);
  EXPECT_GT(report.sleep_cycles, report.thread_cycles);
  EXPECT_EQ(firmware.missed_control_periods(), 0u);
  RecordProperty("longest_us", std::to_string(static_cast<double>(control.longest) / kCore_Hz * 1e6));
  RecordProperty("mean_us", std::to_string(static_cast<double>(control.busy) /
                                           static_cast<double>(control.count) / kCore_Hz * 1e6));
  RecordProperty("stack_bytes", static_cast<int>(report.main_stack_bytes));
}

class BrokenReferenceImage : public testing::TestWithParam<BrokenImage> {};

TEST_P(BrokenReferenceImage, FailsTheMatchingCheckAlone) {
  SuiteOptions o = options(true);
  o.firmware.file = OMNIHIL_BUILD_DIR "/images/reference_" + std::string(GetParam().image) + ".elf";
  if (!std::filesystem::exists(o.firmware.file)) GTEST_SKIP() << "no arm-none-eabi-gcc: no image";
  expect_only_its_check_fails(o, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Images, BrokenReferenceImage, testing::ValuesIn(kBrokenImages),
                         [](const auto& of) { return std::string(of.param.image); });

TEST_F(ReferenceImage, TwoRunsHaveOneHash) { EXPECT_EQ(drive().hash, drive().hash); }

TEST_F(ReferenceImage, PageInTheBoardFileIsTheDefaultRobot) {
  std::ifstream file(kBoard);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  std::vector<mcu::BoardProblem> problems;
  const auto board = mcu::read_board(text, kBoard, problems);
  ASSERT_TRUE(board.has_value());
  ASSERT_EQ(board->flash.size(), 1u);
  EXPECT_EQ(board->flash[0].address, kPage);
  const RobotConfig c = robot_config(one_robot().robots.at(0), kRobot);
  std::vector<std::uint32_t> expected{0x494E4D4F};
  for (const double value : {c.wheel_angle_rad[0], c.wheel_angle_rad[1], c.wheel_angle_rad[2],
                             c.wheel_angle_rad[3], c.wheel_radius_m, c.wheel_center_radius_m, c.gear_ratio,
                             c.encoder_counts_per_rotor_turn, c.bus_voltage_nominal_V, c.motor_resistance_ohm,
                             c.motor_torque_constant_Nm_per_A, c.command_timeout_s}) {
    expected.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  }
  EXPECT_EQ(board->flash[0].words, expected);
}

TEST_F(ReferenceImage, PassesTheWholeShippedSuite) {
  const SuiteReading suite = read_suite({kSuite}, "");
  ASSERT_GE(suite.scenarios.size(), 15u);
  for (const Scenario& s : suite.scenarios) {
    if (s.level == "field") continue;  // its board has no kicker
    for (const CheckResult& r : run_one(s, options(true)).results) {
      EXPECT_TRUE(r.passed) << s.file << ": " << failure_line(r);
    }
  }
}

// rms of the difference over rms of the speed, wheel by wheel; the host build ticks every millisecond, the
// image is looked at twice as often.
TEST_F(ReferenceImage, HostBuildAndImageGiveTheSameWheelSpeedsWithinOnePercent) {
  for (const char* name : {"wheel/speed_step.toml", "wheel/brown_out.toml", "robot/drive_forward.toml"}) {
    const Scenario s = shipped_scenario(name);
    const SessionConfig config = one_robot();
    const ScenarioRun host = run_scenario(s, config, open_firmware({}, config));
    const ScenarioRun image = run_scenario(s, config, image_firmware(kImage, kBoard));
    EXPECT_EQ(image.commands, host.commands);
    for (std::size_t w = 0; w < kWheels; ++w) {
      const auto a = host.trace.column("omega_wheel_rad_s", w),
                 b = image.trace.column("omega_wheel_rad_s", w);
      ASSERT_GE(b.size(), 2 * a.size() - 1);
      double off = 0.0, all = 0.0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_NEAR(host.trace.time_s()[i], image.trace.time_s()[2 * i], 1e-9);
        off += (a[i] - b[2 * i]) * (a[i] - b[2 * i]);
        all += a[i] * a[i];
      }
      RecordProperty(std::string(name) + " wheel " + std::to_string(w), std::to_string(std::sqrt(off / all)));
      EXPECT_LE(std::sqrt(off / all), 0.01) << name << " wheel " << w;
    }
  }
}

}  // namespace
}  // namespace omnihil
