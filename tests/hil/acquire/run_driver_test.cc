// A run packet by packet on made-up time: it begins when the robot is there, and ends with stop packets whatever happens.
#include "hil/acquire/run_driver.h"

#include <gtest/gtest.h>

#include <functional>

namespace omnihil {
namespace {

constexpr std::int64_t kMs = 1'000'000;

AcquirePlan plan_of(double duration_s) {
  AcquirePlan plan;
  plan.packets_Hz = 50.0;
  plan.rest_s = 0.4;
  plan.limits.silence_s = 0.1;
  plan.runs = {{"r", Split::kTraining, "", duration_s, {{0.0, {1, 0, 0}}, {0.5, {2, 0, 0}}}}};
  return plan;
}

struct Sent {
  double at_s;
  double value;
  bool stop;
};

// Runs on a step of 1 ms; `each` says what is heard and seen.
std::vector<Sent> drive(const AcquirePlan& plan, WatchedBy by,
                        const std::function<void(std::int64_t, LimitWatch&, RunDriver&)>& each,
                        std::string& problem, double at_most_s = 20.0) {
  LimitWatch watch(plan.limits, by);
  RunDriver driver(plan, plan.runs[0], watch, 0);
  std::vector<Sent> sent;
  for (std::int64_t now = 0; now < static_cast<std::int64_t>(at_most_s * 1e9); now += kMs) {
    each(now, watch, driver);
    driver.look(now);
    if (const auto p = driver.due(now))
      sent.push_back({1e-9 * static_cast<double>(now), p->value[0], p->stop});
    if (driver.state() == RunState::kDone) break;
  }
  EXPECT_EQ(driver.state(), RunState::kDone);
  problem = driver.problem();
  return sent;
}

void answers(std::int64_t now, LimitWatch& watch) {
  if (now % (20 * kMs) == 0) watch.told(now, {});
}

TEST(RunDriver, AsksWhatThePlanHasAndThenStands) {
  std::string problem;
  const auto sent = drive(
      plan_of(1.0), {.hears = true}, [](std::int64_t now, LimitWatch& w, RunDriver&) { answers(now, w); },
      problem);
  EXPECT_EQ(problem, "");
  int ones = 0, twos = 0;
  for (const Sent& s : sent) {
    ones += s.value == 1.0;
    twos += s.value == 2.0;
    EXPECT_EQ(s.stop, s.value == 0.0);
  }
  EXPECT_EQ(ones, 25);  // 0.5 s at 50 Hz
  EXPECT_EQ(twos, 25);
  ASSERT_GE(sent.size(), 70u);
  for (std::size_t k = sent.size() - 20; k < sent.size(); ++k) EXPECT_TRUE(sent[k].stop);  // 0.4 s at 50 Hz
}

TEST(RunDriver, WithoutAnAnswerNothingMoves) {
  std::string problem;
  const auto sent = drive(
      plan_of(1.0), {.hears = true}, [](std::int64_t, LimitWatch&, RunDriver&) {}, problem);
  EXPECT_NE(problem.find("has not answered at all"), std::string::npos) << problem;
  for (const Sent& s : sent) EXPECT_EQ(s.value, 0.0);
  EXPECT_NEAR(sent.back().at_s, RunDriver::kPatience_s, 0.2);
}

// Each way to be stopped: the next packet says stop, at once, and so do those behind it.
TEST(RunDriver, EveryLimitStopsItAtOnce) {
  struct Case {
    const char* name;
    PlanLimits limits;
    std::function<void(std::int64_t, LimitWatch&, RunDriver&)> fault;  // from 0.6 s on
    const char* says;
    double within_s;
  };
  const auto see = [](double x, double speed) {
    return [=](std::int64_t now, LimitWatch& w, RunDriver&) {
      const double t = 1e-9 * static_cast<double>(now) - 0.6;
      if (now % (16 * kMs) == 0) w.seen(now, {x + speed * t, 0.0, 0.0});
    };
  };
  PlanLimits area, travel, speed, battery, current, silence;
  area.area_m = {{-1, -1, 1, 1}};
  travel.travel_m = 0.3;
  speed.speed_m_s = 1.0;
  battery.battery_V = 20.0;
  current.current_A = 10.0;
  const std::vector<Case> cases{
      {"area", area, see(0.0, 0.9), "outside of the area", 1.1},
      {"travel", travel, see(0.0, 0.5), "from its start", 0.9},
      {"speed", speed, see(0.0, 1.5), "m/s, allowed are 1 m/s", 0.3},
      {"battery", battery,
       [](std::int64_t now, LimitWatch& w, RunDriver&) {
         TelemetryReading r;
         r.battery_V = 19.0;
         w.told(now, r);
       },
       "the battery is at 19.00 V", 0.25},
      {"current", current,
       [](std::int64_t now, LimitWatch& w, RunDriver&) {
         TelemetryReading r;
         r.motor_current_A[2] = -11.0;
         w.told(now, r);
       },
       "11 A in a motor", 0.01},
      {"signal", silence, [](std::int64_t, LimitWatch&, RunDriver& d) { d.stop("stopped by the user"); },
       "by the user", 0.001},
  };
  for (const Case& c : cases) {
    AcquirePlan plan = plan_of(5.0);
    plan.limits = c.limits;
    plan.limits.silence_s = 0.1;
    const bool sees = std::string_view("area travel speed").find(c.name) != std::string_view::npos;
    std::string problem;
    const auto sent = drive(
        plan, {.hears = true, .sees = sees},
        [&](std::int64_t now, LimitWatch& w, RunDriver& d) {
          answers(now, w);
          if (sees && now < 600 * kMs && now % (16 * kMs) == 0) w.seen(now, {0, 0, 0});
          if (now >= 600 * kMs) c.fault(now, w, d);
        },
        problem);
    EXPECT_NE(problem.find(c.says), std::string::npos) << c.name << ": " << problem;
    std::size_t stops = 0;
    for (auto s = sent.rbegin(); s != sent.rend() && s->stop; ++s) ++stops;
    EXPECT_EQ(stops, static_cast<std::size_t>(RunDriver::kStopPackets)) << c.name;
    const Sent& first = sent[sent.size() - stops];
    EXPECT_GT(first.at_s, 0.55) << c.name;  // it did drive before
    EXPECT_LE(first.at_s, 0.6 + c.within_s) << c.name;
    EXPECT_FALSE(sent[sent.size() - stops - 1].stop) << c.name;
  }
}

TEST(RunDriver, ARobotThatFallsSilentIsStopped) {
  std::string problem;
  const auto sent = drive(
      plan_of(5.0), {.hears = true},
      [](std::int64_t now, LimitWatch& w, RunDriver&) {
        if (now < 1000 * kMs) answers(now, w);
      },
      problem);
  EXPECT_NE(problem.find("has not answered for 0.10 s"), std::string::npos) << problem;
  EXPECT_NEAR(sent[sent.size() - RunDriver::kStopPackets].at_s, 0.98 + 0.1, 0.003);
}

TEST(RunDriver, AMomentarilyLowBatteryIsNone) {
  AcquirePlan plan = plan_of(1.0);
  plan.limits.battery_V = 20.0;
  std::string problem;
  drive(
      plan, {.hears = true},
      [](std::int64_t now, LimitWatch& w, RunDriver&) {
        TelemetryReading r;
        r.battery_V = now % (400 * kMs) < 150 * kMs ? 19.0 : 21.0;  // under kLasting_s
        w.told(now, r);
      },
      problem);
  EXPECT_EQ(problem, "");
}

TEST(RunDriver, PacketsThatAreTooLateAreLeftOutNotMadeUpFor) {
  const AcquirePlan plan = plan_of(1.0);
  LimitWatch watch(plan.limits, {});
  RunDriver driver(plan, plan.runs[0], watch, 0);
  driver.look(0);
  EXPECT_TRUE(driver.due(0));
  EXPECT_TRUE(driver.due(105 * kMs));  // due at 20 ms; 40, 60, 80 and 100 ms are left out
  EXPECT_FALSE(driver.due(106 * kMs));
  EXPECT_EQ(driver.left_out(), 4);
  EXPECT_EQ(driver.next_ns(), 120 * kMs);
}

}  // namespace
}  // namespace omnihil
