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
#include "hil/recording/session_setup.h"
#include "tests/hil/one_robot.h"

#if defined(__x86_64__)
#define OMNIHIL_HOST_MACHINE "x86-64 (machine 62)"
#elif defined(__aarch64__)
#define OMNIHIL_HOST_MACHINE "AArch64 (machine 183)"
#else
#define OMNIHIL_HOST_MACHINE ""
#endif

namespace omnihil {
namespace {
const std::string kImage = OMNIHIL_BUILD_DIR "/images/wheels.elf";
const std::string kBoard = OMNIHIL_SOURCE_DIR "/boards/four_wheels_f405.toml";
constexpr double kRotor_rad_s = 60.0;  // in the board file's preset flash

SessionConfig one_robot(std::int64_t step_ns) {
  SessionSetup setup = test::one_robot("omni_default");
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
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(truth.omega_rotor_rad_s[i], kRotor_rad_s, 0.01 * kRotor_rad_s);
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
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(session.plant().truth(0).omega_rotor_rad_s[i], kRotor_rad_s, 0.01 * kRotor_rad_s);
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

std::string said_of(const std::string& board_text, const std::string& served,
                    const std::string& image = kImage) {
  const auto path =
      std::filesystem::temp_directory_path() / ("omnihil-radio-" + std::to_string(::getpid()) + ".toml");
  std::ofstream(path) << board_text;
  SessionConfig config = one_robot(1'000'000);
  config.radio_format = served;
  std::string said;
  try {
    open_firmware({.file = image, .board = path.string()}, config);
  } catch (const std::invalid_argument& error) {
    said = error.what();
  }
  std::filesystem::remove(path);
  return said;
}

std::string with_radio(const std::string& board_file, const std::string& format, const std::string& via) {
  std::ifstream file(board_file);
  std::string text((std::istreambuf_iterator<char>(file)), {});
  if (const std::size_t old = text.find("[radio]"); old != std::string::npos) {
    const std::size_t next = text.find("\n[", old);
    text.erase(old, next == std::string::npos ? next : next - old);
  }
  return text + "\n[radio]\nformat = \"" + format + "\"\nvia = \"" + via + "\"\n";
}

TEST_F(ImageOnBoard, AnUnknownRadioFormatIsRefusedWithThoseThatThereAre) {
  const std::string said = said_of(with_radio(kBoard, "ulaval-hermies", "USART1"), "ulaval-hermes");
  EXPECT_NE(said.find("radio.format = 'ulaval-hermies'"), std::string::npos) << said;
  EXPECT_NE(said.find("unknown"), std::string::npos) << said;
  EXPECT_NE(said.find("roboteam-rem-v8"), std::string::npos) << said;
  EXPECT_NE(said.find(".toml:"), std::string::npos) << "with its line: " << said;
}

TEST_F(ImageOnBoard, ARadioFormatThatIsNotServedIsRefused) {
  const std::string said = said_of(with_radio(kBoard, "ulaval-hermes", "USART1"), "roboteam-rem-v8");
  EXPECT_NE(said.find("radio.format = 'ulaval-hermes'"), std::string::npos) << said;
  EXPECT_NE(said.find("allowed: roboteam-rem-v8"), std::string::npos) << said;
  EXPECT_NE(said.find("--radio ulaval-hermes"), std::string::npos) << said;
  EXPECT_EQ(said_of(with_radio(kBoard, "ulaval-hermes", "USART1"), "ulaval-hermes"), "");
}

TEST_F(ImageOnBoard, ABoardWithoutMotorsIsRefused) {
  const std::string said =
      said_of("format = \"omnihil-board/1\"\nname = \"n\"\nchip = \"stm32f405\"\n", "ulaval-hermes");
  EXPECT_NE(said.find("motor: missing"), std::string::npos) << said;
  EXPECT_NE(said.find("[[motor]]"), std::string::npos) << said;
}

TEST_F(ImageOnBoard, AProgramOfAnotherMachineIsSaidToBeOne) {
  std::ifstream file(kBoard);
  const std::string board((std::istreambuf_iterator<char>(file)), {});
  for (const std::string& other :
       {std::string("/proc/self/exe"),
        std::string(OMNIHIL_BUILD_DIR "/firmware_iface/libomnihil_reference_firmware.so")}) {
    const std::string said = said_of(board, "ulaval-hermes", other);
    EXPECT_NE(said.find("an ELF file for " OMNIHIL_HOST_MACHINE), std::string::npos) << said;
    EXPECT_NE(said.find("needed with --board: a 32-bit ARM executable (machine 40)"), std::string::npos)
        << said;
  }
}

TEST(AvrImageOnBoard, ItsRadioFormatIsLookedAtTheSame) {
  const std::string image = std::string(OMNIHIL_BUILD_DIR) + "/images/omni_reference_avr.hex",
                    board = std::string(OMNIHIL_SOURCE_DIR) + "/boards/omni_reference_avr.toml";
  if (!std::filesystem::exists(image)) GTEST_SKIP() << "no avr-gcc: the image was not built";
  const std::string unknown = said_of(with_radio(board, "morse", "USART0"), "ulaval-hermes", image);
  EXPECT_NE(unknown.find("radio.format = 'morse'"), std::string::npos) << unknown;
  const std::string other = said_of(with_radio(board, "ulaval-hermes", "USART0"), "roboteam-rem-v5", image);
  EXPECT_NE(other.find("allowed: roboteam-rem-v5"), std::string::npos) << other;
}

}  // namespace
}  // namespace omnihil
