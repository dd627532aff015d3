// Commands that were sent and not heard, found by what the wheels did; and what is left as it is.
#include "identify/estimate/heard_commands.h"

#include <gtest/gtest.h>

#include "tests/identify/simulated_radio.h"

namespace omnihil {
namespace {

using test::measured_without;
using test::radio_candidate;
using test::staircase;
using test::with_quiet_wheels;

Candidate late_truth() {
  Candidate truth = radio_candidate();
  EXPECT_EQ(set_value(truth, "controller.latency_s", 0.026), "");  // believed: 0.02
  EXPECT_EQ(set_value(truth, "motor.resistance_ohm", 0.48), "");   // 0.464
  return truth;
}

TEST(HeardCommands, AreThoseThatTheWheelsFollowed) {
  const std::vector<std::size_t> lost = {40, 77, 78, 131, 205};
  const Dataset d = measured_without(with_quiet_wheels(staircase(5.0)), lost, late_truth());
  const HeardCommands heard = heard_commands(d, radio_candidate(), {.jobs = 2});
  ASSERT_EQ(heard.lost.size(), 2u);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(heard.lost[r].rows, lost) << r;
    for (const std::size_t k : lost)
      EXPECT_TRUE(std::isnan(heard.dataset.runs[r].signals.at("command_vy")[k]));
  }
  EXPECT_EQ(heard.lost_packets(), 10u);
  EXPECT_EQ(heard.dataset.notes.size(), d.notes.size() + 2);
  const HeardCommands again = heard_commands(heard.dataset, radio_candidate(), {});
  EXPECT_EQ(again.lost_packets(), 0u);  // once is enough
  EXPECT_EQ(again.dataset.notes, heard.dataset.notes);
}

TEST(HeardCommands, AreAllWhereNoneWasLost) {
  const Dataset d = measured_without(with_quiet_wheels(staircase(5.0)), {}, late_truth());
  const HeardCommands heard = heard_commands(d, radio_candidate(), {});
  EXPECT_EQ(heard.lost_packets(), 0u);
  EXPECT_EQ(heard.dataset.notes, d.notes);
}

// A robot that follows nothing it is told has lost no packets: the model is wrong.
TEST(HeardCommands, AreAllWhereTheModelFollowsLittle) {
  Dataset d = measured_without(with_quiet_wheels(staircase(5.0)), {}, late_truth());
  for (auto& run : d.runs)
    for (int i = 1; i <= 4; ++i)
      for (double& v : run.signals["wheel_speed_" + std::to_string(i)]) v = 0.0;
  EXPECT_EQ(heard_commands(d, radio_candidate(), {}).lost_packets(), 0u);
}

// One wheel of 95 % of its radius is no lost command: a model that knows of it tells them apart.
TEST(HeardCommands, AreDecidedByAModelThatIsRightWhereTheFirstWasWrong) {
  const std::vector<std::size_t> lost = {40, 77, 78, 131, 205};
  Candidate truth = with_effect(late_truth(), *find_effect("wheel_radius_mismatch"));
  ASSERT_EQ(set_value(truth, "wheel_radius_mismatch.ratio_1", 0.95), "");
  const Dataset d = measured_without(with_quiet_wheels(staircase(5.0)), lost, truth);
  const HeardCommands first = heard_commands(d, radio_candidate(), {});
  const HeardCommands second = heard_by(d, radio_candidate(), truth);
  EXPECT_FALSE(second.same_lost(first));
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_NE(first.lost[r].rows, lost) << r;
    EXPECT_EQ(second.lost[r].rows, lost) << r;
  }
  EXPECT_TRUE(second.dataset.heard);
  EXPECT_EQ(second.dataset.notes.size(), d.notes.size() + 2);
}

TEST(HeardCommands, LeaveARobotThatDutiesDriveAsItIs) {
  const Dataset d = test::robot_record({}, 1.0);
  const HeardCommands heard = heard_commands(d, test::robot_candidate(), {});
  EXPECT_EQ(heard.lost_packets(), 0u);
  EXPECT_EQ(heard.dataset.runs[0].signals.at("duty_1"), d.runs[0].signals.at("duty_1"));
}

}  // namespace
}  // namespace omnihil
