// The file behind a board's memory card: read, left alone or replaced whole, refused where it cannot serve.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "hil/firmware/image_firmware.h"
#include "hil/loop/model_store.h"
#include "hil/recording/session_setup.h"

namespace omnihil {
namespace {
namespace fs = std::filesystem;
const std::string kImage = OMNIHIL_BUILD_DIR "/images/card.elf";
constexpr std::size_t kBytes = 1 << 20, kBlock = 512;

std::string block_of(const std::string& file, std::size_t number) {
  return file.substr(kBlock * number, kBlock);
}
std::string one_more(std::string block) {
  for (char& c : block) c = static_cast<char>(c + 1);
  return block;
}

struct CardFile : testing::Test {
  void SetUp() override {
    if (!fs::exists(kImage)) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
    folder = fs::temp_directory_path() / ("omnihil-cards-" + std::to_string(::getpid()));
    fs::create_directories(folder);
    contents.resize(kBytes);
    for (std::size_t i = 0; i < kBytes; ++i) contents[i] = static_cast<char>(i * 31 + i / kBlock);
    write("card.img", contents);
    write("card0.img", contents);
  }
  void TearDown() override { fs::remove_all(folder); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) {
    std::ifstream file(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // Runs the image for 50 ms with this in its device's table; what is said if it is refused.
  std::string run(const std::string& device, std::vector<int> robots = {0}) {
    write("board.toml",
          "format = \"omnihil-board/1\"\nname = \"n\"\nchip = \"stm32h743\"\n[[motor]]\nwheel = 0\npwm = "
          "\"TIM1.1\"\n[[device]]\nkind = \"sd_card\"\nbus = \"SDMMC1\"\n" +
              device);
    SessionSetup setup;
    setup.model = load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
    setup.radio_format = "ulaval-hermes";
    setup.robot_ids = std::move(robots);
    setup.plant.physics = Physics::kPlanar;
    setup.step_ns = 1'000'000;
    try {
      Session session(session_config(setup), image_firmware(kImage, (folder / "board.toml").string()));
      std::vector<std::uint8_t> out;
      while (session.now_ns() < 50'000'000) session.step({}, out);
      std::string report;
      for (const std::string& line : session.firmware(0).report()) report += line + "\n";
      return report;
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  }
  fs::path folder;
  std::string contents;
};

TEST_F(CardFile, StaysAsItIsWhatEverTheImageWrites) {
  EXPECT_EQ(run("image = \"card.img\"\n"), "");
  EXPECT_EQ(read("card.img"), contents);
}

TEST_F(CardFile, IsReplacedWholeAtTheEndWhereItMayBeWritten) {
  EXPECT_EQ(run("image = \"card{id}.img\"\nwritable = true\n"), "");
  const std::string after = read("card0.img");
  ASSERT_EQ(after.size(), contents.size());
  EXPECT_EQ(block_of(after, 2), one_more(block_of(contents, 1)));
  std::string rest = after;
  rest.replace(2 * kBlock, kBlock, block_of(contents, 2));
  EXPECT_EQ(rest, contents) << "no other block has changed";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 3) << "and nothing else is left there";
}

TEST_F(CardFile, OneForSeveralRobotsIsReadByAllAndWrittenByNone) {
  EXPECT_EQ(run("image = \"card.img\"\n", {0, 1}), "");
  const std::string said = run("image = \"card.img\"\nwritable = true\n", {0, 1});
  EXPECT_NE(said.find("is written by another board"), std::string::npos) << said;
  EXPECT_EQ(read("card.img"), contents);
}

TEST_F(CardFile, ThatCannotServeIsNamedWithItsReason) {
  EXPECT_NE(run("image = \"none.img\"\n").find("cannot be read"), std::string::npos);
  write("odd.img", contents.substr(1));
  EXPECT_NE(run("image = \"odd.img\"\n").find("multiple of 512 KiB"), std::string::npos);
  EXPECT_NE(run("").find("missing"), std::string::npos);
  EXPECT_NE(run("image = \".\"\n").find("no regular file"), std::string::npos);
}

}  // namespace
}  // namespace omnihil
