// What a bench says of its load: the words from the numbers, and that something is measured.
#include "hil/serve/serve_load.h"

#include <gtest/gtest.h>

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
