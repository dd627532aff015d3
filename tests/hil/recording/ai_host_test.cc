// An AI host that other people wrote, at our bench: what it wrote to its dongle while it saw its robots by our vision, fed in
// again at the same times. It lines six robots up and takes a direct free kick, with nothing but these bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "firmware_iface/host_firmware.h"
#include "hil/recording/session_setup.h"
#include "hil/recording/stream_file.h"
#include "sim/field/field_size.h"

namespace omnihil {
namespace {

constexpr int kRobots = 6;
constexpr double kBallX_m = -1.5, kBallY_m = 0.6;

SessionSetup bench() {
  SessionSetup setup;
  setup.model = load_robot_model("ulaval_delta", {OMNIHIL_SOURCE_DIR "/models"}).bundle;
  setup.radio_format = "ulaval-hermes";
  setup.robot_ids = {0, 1, 2, 3, 4, 5};
  setup.plant.physics = Physics::kPlanar;
  setup.field.contacts = true;
  setup.field.size = &kFieldDivisionB;
  setup.field.ball_m = {kBallX_m, kBallY_m};
  return setup;
}

struct Kick {
  double time_s = 0.0;
  int robot = -1;
};

class Match : public SessionObserver {
 public:
  void world(std::int64_t now_ns, const World& world) override {
    for (const WorldEvent& event : world.events()) {
      if (event.kind == WorldEventKind::kKick)
        kicks.push_back({1e-9 * static_cast<double>(now_ns), event.robot});
    }
  }
  std::vector<Kick> kicks;
};

class AiHost : public ::testing::Test {
 protected:
  void run_until(double time_s) {
    std::vector<std::uint8_t> bytes, answer;
    while (session_.now_ns() < static_cast<std::int64_t>(std::llround(1e9 * time_s))) {
      bytes.clear();
      for (; next_ < stream_.chunks.size() && stream_.chunks[next_].at_ns <= session_.now_ns(); ++next_)
        bytes.insert(bytes.end(), stream_.chunks[next_].bytes.begin(), stream_.chunks[next_].bytes.end());
      session_.step(bytes, answer);
    }
  }

  Vector3 ball() const { return session_.world().ball()->position; }

  HostStream stream_ =
      load_stream(OMNIHIL_SOURCE_DIR "/tests/data/hosts/strategyai-direct-free-kick.txt", "");
  std::size_t next_ = 0;
  Match match_;
  Session session_{session_config(bench()), make_reference_firmware};
};

std::uint64_t frames_of(const HostStream& stream) {  // each ends with the only 00 in it
  std::uint64_t count = 0;
  for (const StreamChunk& chunk : stream.chunks)
    count += static_cast<std::uint64_t>(std::count(chunk.bytes.begin(), chunk.bytes.end(), 0));
  return count;
}

TEST_F(AiHost, EveryFrameItWritesIsTaken) {
  run_until(1e-9 * static_cast<double>(stream_.duration_ns()) + 0.1);
  EXPECT_GT(frames_of(stream_), 2'000u);
  EXPECT_EQ(session_.link().from_host().good, frames_of(stream_));
  EXPECT_EQ(session_.link().from_host().refused(), 0u);
}

// Its LineUp: beside its goal's area (3.5 m of division B) by three robot radii of 90 mm, four radii apart.
TEST_F(AiHost, LinesSixRobotsUp) {
  constexpr double kRadius_m = 0.09, kGoalArea_m = 3.5;
  constexpr double kArrived_m = 0.06;  // a choice: the widest stopped 45 mm off
  run_until(14.5);
  for (int i = 0; i < kRobots; ++i) {
    const RobotTruth truth = session_.plant().truth(i);
    EXPECT_NEAR(truth.x_m, kGoalArea_m - 3.0 * kRadius_m, kArrived_m) << i;
    EXPECT_NEAR(truth.y_m, (i - 0.5 * (kRobots - 1)) * 4.0 * kRadius_m, kArrived_m) << i;
    EXPECT_NEAR(truth.v_forward_m_s, 0.0, 0.01) << i;
  }
}

TEST_F(AiHost, TakesADirectFreeKickIntoTheGoal) {
  session_.set_observer(&match_);
  run_until(21.0);  // the referee has not given it yet: nobody touches the ball
  EXPECT_NEAR(std::hypot(ball().x() - kBallX_m, ball().y() - kBallY_m), 0.0, 1e-3);
  EXPECT_TRUE(match_.kicks.empty());
  for (double t_s = 21.0; match_.kicks.empty() && t_s < 25.4; t_s += 0.001) run_until(t_s);
  ASSERT_EQ(match_.kicks.size(), 1u);
  const Kick kick = match_.kicks.front();
  EXPECT_EQ(kick.robot, 1) << "the one that it said would";
  const Vector3 from = ball();
  run_until(kick.time_s + 0.1);
  const Vector3 way = ball() - from;
  EXPECT_LT(way.x(), -0.1);  // towards the other side, 1 m/s and more
  const double at_goal_line_y_m = from.y() + way.y() / way.x() * (-4.5 - from.x());
  EXPECT_LT(std::abs(at_goal_line_y_m), 0.5) << "the goal is 1 m wide";
}

}  // namespace
}  // namespace omnihil
