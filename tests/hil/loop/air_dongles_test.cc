// In every dongle: what the air makes late, double or wrong.
#include <gtest/gtest.h>

#include "hil/loop/air.h"
#include "tests/protocols/dongles/air_drive.h"

namespace omnihil {
namespace {

std::pair<double, double> nowhere(int) { return {0.0, 0.0}; }

class EveryDongleOnTheAir : public testing::TestWithParam<const RadioFormat*> {
 protected:
  void SetUp() override {
    if (!has_velocity(*GetParam())) GTEST_SKIP() << "has no packet for a body velocity";
  }
};

TEST_P(EveryDongleOnTheAir, ALatePacketIsAsMuchLater) {
  const RadioFormat& format = *GetParam();
  const Passed without = drive_link(format, nullptr);
  Air slow({.latency_least_s = 0.003, .latency_mean_s = 0.003}, 1, nowhere);
  const Passed late = drive_link(format, &slow);
  // Who has to be told that a host is there hears it later, too: a command may come to deaf ears meanwhile.
  EXPECT_GE(late.drives, without.drives - 1);
  EXPECT_LE(late.drives, without.drives);
  if (late.drives == without.drives) {
    EXPECT_EQ(late.first_ns, without.first_ns + 3'000'000);
  }
  EXPECT_EQ(late.last_ns, without.last_ns + 3'000'000);
  if (without.from_robots > 0) {
    // A list of answers goes out in time, without those that are late.
    if (format.list == nullptr) {
      EXPECT_GE(late.first_answer_ns, without.first_answer_ns + 3'000'000);
    }
    EXPECT_GT(late.from_robots, without.from_robots / 2);
  }
}

TEST_P(EveryDongleOnTheAir, APacketThatComesTwiceActsTwice) {
  const RadioFormat& format = *GetParam();
  const Passed without = drive_link(format, nullptr);
  Air twice({.twice_share = 1.0}, 1, nowhere);
  const Passed both = drive_link(format, &twice);
  EXPECT_EQ(both.drives, 2 * without.drives);
  EXPECT_GE(both.from_robots, without.from_robots);
  EXPECT_GT(twice.counts().twice, 0U);
}

// Whatever is flipped, nothing breaks; what a format sees of it is counted, and the rest is acted on.
TEST_P(EveryDongleOnTheAir, WrongBitsAreCountedAndNeverBreakIt) {
  const RadioFormat& format = *GetParam();
  const Passed without = drive_link(format, nullptr);
  for (const double rate : {0.001, 0.01, 0.1, 0.5}) {
    Air noisy({.twice_share = 0.2, .bit_error_rate = rate}, 5, nowhere);
    const Passed passed = drive_link(format, &noisy);
    EXPECT_EQ(passed.from_host, without.from_host);  // the wire is clean, the air is not
    const AirCounts counts = noisy.counts();
    EXPECT_GT(counts.refused[0] + counts.slipped[0], 0U) << rate;
    EXPECT_EQ(counts.crowded[0] + counts.crowded[1], 0U) << rate;
    EXPECT_GE(passed.refused, counts.refused[1]) << rate;
    if (rate == 0.5) {
      EXPECT_LT(passed.drives, without.drives);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryDongleOnTheAir,
                         testing::ValuesIn(radio_formats().begin(), radio_formats().end()), format_name);

// One robot of format without a checksum, and of one with: of single flips the first lets pass what its table allows
// (and no more), the second nothing.
TEST(WrongBits, SumsAndCyclicSumsSeeFewFlipsAndRawTablesDoNot) {
  for (const auto& [id, sees] : {std::pair{"ulaval-hermes", true}, std::pair{"ateam-rnp-2026", true},
                                 std::pair{"roboteam-rem-v8", false}}) {
    const RadioFormat* format = find_radio_format(id);
    ASSERT_NE(format, nullptr) << id;
    Air rare({.bit_error_rate = 2e-4}, 77, nowhere);  // two flips in a packet of 200 bits: one of 1250
    for (int n = 0; n < 20; ++n) drive_link(*format, &rare);
    const AirCounts counts = rare.counts();
    EXPECT_GT(counts.refused[0] + counts.slipped[0], 20U) << id;
    if (sees) {
      EXPECT_EQ(counts.slipped[0], 0U) << id;
    } else {
      EXPECT_GT(counts.slipped[0], 10U) << id;
    }
  }
}

}  // namespace
}  // namespace omnihil
