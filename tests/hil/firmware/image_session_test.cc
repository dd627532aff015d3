// An image of our own on an emulated board drives the simulated robot, in lock-step.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "hil/firmware/image_firmware.h"
#include "hil/firmware/open_firmware.h"
#include "hil/loop/model_store.h"
#include "hil/recording/session_setup.h"

namespace omnihil {
namespace {
const std::string kImage = OMNIHIL_BUILD_DIR "/images/wheels.elf";
const std::string kBoard = OMNIHIL_SOURCE_DIR "/boards/four_wheels_f405.toml";
constexpr double kRotor_rad_s = 60.0;  // in the board file's preset flash

SessionConfig one_robot(std::int64_t step_ns) {
  SessionSetup setup;
  setup.model = load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
  setup.radio_format = "ulaval-hermes";
  setup.robot_ids = {0};
  setup.plant.physics = Physics::kPlanar;
  setup.step_ns = step_ns;
  return session_config(setup);
}

RobotTruth run(std::int64_t step_ns, double duration_s, std::vector<std::string>* report = nullptr) {
  Session session(one_robot(step_ns), image_firmware(kImage, kBoard));
  std::vector<std::uint8_t> out;
  while (session.now_ns() < static_cast<std::int64_t>(duration_s * 1e9)) session.step({}, out);
  if (report != nullptr) *report = session.firmware(0).report();
  return session.plant().truth(0);
}

struct ImageOnBoard : testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(kImage)) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
  }
};

TEST_F(ImageOnBoard, ReachesItsWheelSpeedsWithinOnePercent) {
  std::vector<std::string> report;
  const RobotTruth truth = run(1'000'000, 1.5, &report);
  for (const double omega : truth.omega_rotor_rad_s) EXPECT_NEAR(omega, kRotor_rad_s, 0.01 * kRotor_rad_s);
  for (const std::string& line : report) EXPECT_EQ(line, "");
}

TEST_F(ImageOnBoard, GivesTheSameBitsWhateverTheLoopStep) {
  const RobotTruth one = run(1'000'000, 0.3);
  for (const std::int64_t step_ns : {500'000, 5'000'000, 10'000'000}) {
    const RobotTruth other = run(step_ns, 0.3);
    EXPECT_EQ(one.omega_rotor_rad_s, other.omega_rotor_rad_s);
    EXPECT_EQ(one.theta_rotor_rad, other.theta_rotor_rad);
  }
}

// The image controls four wheels; here each of four boards has but its first motor wired.
TEST_F(ImageOnBoard, SeveralBoardsDriveOneWheelEach) {
  std::ifstream file(kBoard);
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::size_t second = text.find("[[motor]]", text.find("[[motor]]") + 1),
                    end = text.find("[[analog]]");
  text.erase(second, end - second);
  text.insert(text.find("coupling_us"), "boards_per_robot = 4\n");
  const auto path =
      std::filesystem::temp_directory_path() / ("omnihil-boards-" + std::to_string(::getpid()) + ".toml");
  std::ofstream(path) << text;
  Session session(one_robot(1'000'000), image_firmware(kImage, path.string()));
  std::filesystem::remove(path);
  std::vector<std::uint8_t> out;
  while (session.now_ns() < 1'500'000'000) session.step({}, out);
  for (const double omega : session.plant().truth(0).omega_rotor_rad_s) {
    EXPECT_NEAR(omega, kRotor_rad_s, 0.01 * kRotor_rad_s);
  }
}

TEST_F(ImageOnBoard, IsOpenedByWhatTheUserNames) {
  const SessionConfig config = one_robot(1'000'000);
  FirmwareChoice choice;
  choice.file = kImage;
  EXPECT_THROW(open_firmware(choice, config), std::invalid_argument);  // no board
  choice.board = kBoard;
  Session session(config, open_firmware(choice, config));
  EXPECT_EQ(session.firmware(0).name(), "image on four wheels, STM32F405 (stm32f405)");
}

TEST_F(ImageOnBoard, FilesThatCannotBeUsedAreAllNamed) {
  try {
    image_firmware(kBoard, kImage);  // the wrong way round
    FAIL();
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("firmware " + kBoard), std::string::npos) << text;
    EXPECT_NE(text.find(kImage + ":"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace omnihil
