// Every dongle asks the air: where it takes everything nothing reaches a robot and no robot answers, where it takes
// nothing all is as without one.
#include <gtest/gtest.h>

#include "protocols/radio_format.h"
#include "tests/protocols/dongles/air_drive.h"

namespace omnihil {
namespace {

struct FixedAir : RadioAir {
  explicit FixedAir(bool takes_all) : takes(takes_all) {}
  bool lost(int, AirWay way) override {
    (way == AirWay::kToRobot ? to_robot : to_host) += 1;
    return takes;
  }
  bool takes;
  int to_robot = 0, to_host = 0;
};

class EveryDongle : public testing::TestWithParam<const RadioFormat*> {};

TEST_P(EveryDongle, AsksTheAirForWhatPasses) {
  const RadioFormat& format = *GetParam();
  if (!has_velocity(format)) GTEST_SKIP() << "has no packet for a body velocity";
  const Passed without = drive_link(format, nullptr);
  FixedAir clear(false), dead(true);
  const Passed passed = drive_link(format, &clear), none = drive_link(format, &dead);
  EXPECT_EQ(passed.drives, without.drives);
  EXPECT_EQ(passed.from_robots, without.from_robots);
  EXPECT_EQ(none.drives, 0);
  // A dongle that collects its robots' answers in a list gives the list all the same, with nothing in it.
  if (format.list == nullptr) {
    EXPECT_EQ(none.from_robots, 0U);
  }
  EXPECT_GE(clear.to_robot, without.drives);
  // RoboTeam's robots stitch feedback and state info into one packet of the air.
  const std::uint64_t stitched = format.id.starts_with("roboteam-rem") ? 2 : 1;
  EXPECT_GE(stitched * static_cast<std::uint64_t>(clear.to_host), without.from_robots);
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryDongle,
                         testing::ValuesIn(radio_formats().begin(), radio_formats().end()), format_name);

}  // namespace
}  // namespace omnihil
