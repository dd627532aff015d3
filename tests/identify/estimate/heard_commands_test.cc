// Commands that were sent and not heard, found by what the wheels did; and what is left as it is.
#include "identify/estimate/heard_commands.h"

#include <gtest/gtest.h>

#include "tests/identify/simulated_radio.h"

namespace omnihil {
namespace {

using test::blank_radio;
using test::radio_candidate;

// A host that says something new in most packets: a staircase along two axes.
Dataset staircase(double duration_s) {
  Dataset d = blank_radio(duration_s);
  for (Run& run : d.runs) {
    for (std::size_t k = 0; k < run.time_s.size(); ++k) {
      const double t = run.time_s[k];
      run.signals["command_vx"][k] = t < 0.3 ? 0.0 : 0.02 * std::round(40.0 * std::sin(2.1 * t));
      run.signals["command_vy"][k] = t < 0.3 ? 0.0 : 0.02 * std::round(30.0 * std::sin(2.9 * t));
      run.signals["command_w"][k] = 0.0;
    }
  }
  return d;
}

// What a robot did that did not hear the commands of `lost`; the file says what was sent.
Dataset measured_without(const Dataset& sent, const std::vector<std::size_t>& lost, const Candidate& truth) {
  Dataset heard = sent;
  for (Run& run : heard.runs)
    for (const std::size_t k : lost)
      for (const char* name : {"command_vx", "command_vy", "command_w"}) run.signals[name][k] = kMissing;
  Dataset out = test::measured(heard, *make_predictor(heard, radio_candidate(), {})->simulated(truth, 3));
  for (std::size_t r = 0; r < out.runs.size(); ++r)
    for (const char* name : {"command_vx", "command_vy", "command_w"})
      out.runs[r].signals[name] = sent.runs[r].signals.at(name);
  return out;
}

// The wheels tell speeds to 0.05 rad/s; blank_radio's 0.3 hides a command that is one packet late.
Dataset with_quiet_wheels(Dataset d) {
  for (Channel& c : d.channels)
    if (c.signal.starts_with("wheel_speed")) c.sigma = 0.05;
  return d;
}

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

TEST(HeardCommands, LeaveARobotThatDutiesDriveAsItIs) {
  const Dataset d = test::robot_record({}, 1.0);
  const HeardCommands heard = heard_commands(d, test::robot_candidate(), {});
  EXPECT_EQ(heard.lost_packets(), 0u);
  EXPECT_EQ(heard.dataset.runs[0].signals.at("duty_1"), d.runs[0].signals.at("duty_1"));
}

}  // namespace
}  // namespace omnihil
