// What a bench says of its load: the words from the numbers, and that something is measured.
#include "hil/serve/serve_load.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "hil/firmware/open_firmware.h"
#include "tests/hil/recording/real_run.h"

namespace omnihil {
namespace {

TEST(ServeLoad, SaysOneLineWhereItFits) {
  EXPECT_EQ(load_words({.core_ratio = 0.123, .robots = 6}),
            "load about 12 % of a core for 6 robots (measured, with this program's firmware)\n");
  EXPECT_EQ(load_words({.core_ratio = 0.0123, .planar = true, .robots = 1}),
            "load about 1.2 % of a core for 1 robot (measured, with this program's firmware)\n");
  EXPECT_EQ(load_words({}), "");
}

TEST(ServeLoad, SaysWhatToChangeWhereItDoesNot) {
  const std::string tight = load_words({.core_ratio = 0.9, .planar_ratio = 0.1, .robots = 12});
  EXPECT_NE(tight.find("may not keep up"), std::string::npos) << tight;
  EXPECT_NE(tight.find("--physics planar, the same robots in closed form, takes 10 %"), std::string::npos)
      << tight;
  const std::string over = load_words({.core_ratio = 1.7, .planar_ratio = 0.9, .robots = 22});
  EXPECT_NE(over.find("will not keep up"), std::string::npos) << over;
  EXPECT_NE(over.find("fewer robots, or --clock free (--physics planar would not do)"), std::string::npos)
      << over;
  const std::string planar = load_words({.core_ratio = 1.7, .planar = true, .robots = 22});
  EXPECT_NE(planar.find("fewer robots, or --clock free\n"), std::string::npos) << planar;
}

TEST(ServeLoad, SaysWhatEachRobotsBoardsTakeAndWhatTheBusiestCoreHas) {
  ServeLoad load{.core_ratio = 0.9, .robots = 4};
  load.boards = {{0, 0.2}, {1, 0.2}, {3, 0.2}, {kOpponentKey + 0, 0.1}};
  EXPECT_EQ(load_words(load).substr(0, load_words(load).find("load: that")),
            "load about 90 % of a core for 4 robots (measured)\n"
            "load: of that emulated boards: robots 0-1 20 % each, robot 3 20 %, opponent 0 10 %\n");
  load.threads = 2;  // the rest, 0.2, and half of 0.7
  EXPECT_NEAR(load.busiest_core_ratio(), 0.55, 1e-12);
  EXPECT_NE(load_words(load).find("load: boards shared out over 2 cores, 55 % of the busiest one\n"),
            std::string::npos);
  EXPECT_EQ(load_words(load).find("keep up"), std::string::npos);
  load.threads = 8;  // no robot is taken apart
  EXPECT_NEAR(load.busiest_core_ratio(), 0.4, 1e-12);
}

TEST(ServeLoad, BoardsAreMeasuredAsTheyAreAndByThemselves) {
  const std::string image = OMNIHIL_BUILD_DIR "/images/wheels.elf";
  if (!std::filesystem::exists(image)) GTEST_SKIP() << "no arm-none-eabi-gcc: the image was not built";
  SessionConfig config = session_config(real::setup(real::kHermes));
  config.threads = 2;
  const FirmwareChoice choice{.file = image, .board = OMNIHIL_SOURCE_DIR "/boards/four_wheels_f405.toml"};
  const ServeLoad load = measured_load(config, {open_firmware_for_load(choice, config), {}});
  ASSERT_EQ(load.boards.size(), 2u);
  EXPECT_EQ(load.boards[0].key, config.robot_ids[0]);
  EXPECT_EQ(load.boards[1].key, config.robot_ids[1]);
  for (const ServeLoad::Share& share : load.boards) {
    EXPECT_GT(share.core_ratio, 0.0);
    EXPECT_LT(share.core_ratio, load.core_ratio);
  }
  EXPECT_EQ(load.threads, 2);
  // Nothing of an image runs here without one.
  EXPECT_TRUE(measured_load(config, {open_firmware_for_load({}, config), {}}).boards.empty());
}

TEST(ServeLoad, IsMeasuredOfBothTeamsAndOfNothingThatCannotBe) {
  SessionSetup setup = real::setup(real::kHermes);
  setup.opponent_ids = {1};
  const ServeLoad load = measured_load(session_config(setup));
  EXPECT_GT(load.core_ratio, 0.0);
  EXPECT_TRUE(load.planar);
  EXPECT_EQ(load.robots, 3);
  SessionConfig broken = session_config(setup);
  broken.radio_format = "none";
  EXPECT_EQ(measured_load(broken).core_ratio, 0.0);
}

}  // namespace
}  // namespace omnihil
