// `omnihil serve` with an image and its board file, as a user starts it.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/tools/cli.h"

namespace omnihil {
namespace {
const std::string kImage = OMNIHIL_BUILD_DIR "/images/wheels.elf";
const std::string kBoard = OMNIHIL_SOURCE_DIR "/boards/four_wheels_f405.toml";

struct ServeImage : CliTest {
  void SetUp() override {
    CliTest::SetUp();
    if (!std::filesystem::exists(kImage)) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
    folder = std::filesystem::temp_directory_path() / ("omnihil-serve-image-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  Ran serve(const std::string& image, const std::string& board) const {
    return run_omnihil("serve --clock free --duration 0.2 --robots 0-1 --physics planar --device" +
                       shell(folder / "dongle") + "--firmware" + shell(image) + "--board" + shell(board));
  }
  std::filesystem::path folder;
};

TEST_F(ServeImage, RunsItOnTwoRobots) {
  const Ran ran = serve(kImage, kBoard);
  EXPECT_EQ(ran.exit_code, 0) << ran.text;
  EXPECT_FALSE(ran.says("not modelled")) << ran.text;
}

const std::string kFaults = OMNIHIL_BUILD_DIR "/images/faults.elf",
                  kStays = OMNIHIL_BUILD_DIR "/images/faults_stays.elf";

TEST_F(ServeImage, AnImageThatOnlyFaultsAndResetsEndsWithSix) {
  const Ran ran = serve(kFaults, kBoard);
  EXPECT_EQ(ran.exit_code, 6) << ran.text;
  EXPECT_TRUE(ran.says("faults and is reset, twice in a row")) << ran.text;
  EXPECT_TRUE(ran.says("read_nowhere")) << ran.text;
}

TEST_F(ServeImage, EqualLinesOfSeveralRobotsAreOne) {
  const Ran ran = serve(kFaults, kBoard);
  EXPECT_TRUE(ran.says("robots 0-1")) << ran.text;
  const std::size_t first = ran.text.find("fault: HardFault");
  ASSERT_NE(first, std::string::npos) << ran.text;
  EXPECT_EQ(ran.text.find("fault: HardFault", first + 1), std::string::npos) << ran.text;
}

TEST_F(ServeImage, AnImageThatStaysInItsFaultHandlerEndsWithSix) {
  const Ran ran =
      run_omnihil("serve --clock free --duration 0.5 --robots 0 --physics planar --device" +
                  shell(folder / "dongle") + "--firmware" + shell(kStays) + "--board" + shell(kBoard));
  EXPECT_EQ(ran.exit_code, 6) << ran.text;
  EXPECT_TRUE(ran.says("stays in its fault handler")) << ran.text;
}

TEST_F(ServeImage, AScenarioWithSuchAnImageEndsWithSix) {
  const Ran ran = run_omnihil("scenario run wheel/direction --no-plots --firmware" + shell(kFaults) +
                              "--board" + shell(kBoard));
  EXPECT_EQ(ran.exit_code, 6) << ran.text;
}

TEST_F(ServeImage, NamesEveryMistakeOfTheBoardFileAndEndsWithTwo) {
  std::ifstream good(kBoard);
  std::string text((std::istreambuf_iterator<char>(good)), {});
  text.replace(text.find("TIM1.1"), 6, "TIM1.7");
  text.replace(text.find("ADC1"), 4, "ADC7");
  const std::filesystem::path bad = folder / "bad.toml";
  std::ofstream(bad) << text;
  const Ran ran = serve(kImage, bad.string());
  EXPECT_EQ(ran.exit_code, 2) << ran.text;
  EXPECT_TRUE(ran.says("motor[0].pwm = 'TIM1.7'")) << ran.text;
  EXPECT_TRUE(ran.says("analog[0].adc = 'ADC7'")) << ran.text;
}

}  // namespace
}  // namespace omnihil
