// A real game among virtual robots: tracks by the filter's closed forms, and what meets what.
#include "hil/league/real_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hil/league/messages/ssl_vision.pb.h"

namespace omnihil {
namespace {

constexpr std::int64_t kFrame_ns = 1'000'000'000 / 60;

struct Seen {
  int id;
  double x_m, y_m, yaw_rad;
};

std::string frame(const std::vector<Seen>& yellow, const std::vector<std::pair<double, double>>& balls = {},
                  double age_s = 0.0) {
  league::SSL_WrapperPacket packet;
  league::SSL_DetectionFrame& f = *packet.mutable_detection();
  f.set_frame_number(1);
  f.set_camera_id(0);
  f.set_t_capture(1000.0);
  f.set_t_sent(1000.0 + age_s);
  for (const Seen& s : yellow) {
    auto& r = *f.add_robots_yellow();
    r.set_confidence(1.0f);
    r.set_robot_id(static_cast<unsigned>(s.id));
    r.set_x(static_cast<float>(1e3 * s.x_m));
    r.set_y(static_cast<float>(1e3 * s.y_m));
    r.set_orientation(static_cast<float>(s.yaw_rad));
    r.set_pixel_x(0);
    r.set_pixel_y(0);
  }
  for (const auto& [x_m, y_m] : balls) {
    auto& b = *f.add_balls();
    b.set_confidence(0.9f);
    b.set_x(static_cast<float>(1e3 * x_m));
    b.set_y(static_cast<float>(1e3 * y_m));
    b.set_pixel_x(0);
    b.set_pixel_y(0);
  }
  return packet.SerializeAsString();
}

// A constant speed is followed without lag: the filter is of first order.
TEST(RealField, FollowsAConstantSpeedWithoutLag) {
  RealField real({});
  std::int64_t now_ns = 0;
  const double v = 1.5, w = 3.0;
  for (int n = 0; n < 60; ++n, now_ns += kFrame_ns) {
    const double t = 1e-9 * static_cast<double>(now_ns);
    EXPECT_TRUE(real.packet(frame({{4, v * t, 1.0, std::remainder(w * t, 2 * M_PI)}}), now_ns));
  }
  const std::int64_t at_ns = now_ns - kFrame_ns + 5'000'000;
  const auto movers = real.movers(at_ns);
  ASSERT_EQ(movers.size(), 1u);
  const PlanarState& s = movers[0].state;
  const double t = 1e-9 * static_cast<double>(at_ns);
  EXPECT_NEAR(s.x_m, v * t, 1e-4);
  EXPECT_NEAR(s.y_m, 1.0, 1e-6);
  EXPECT_NEAR(s.v_x_m_s, v, 1e-3);
  EXPECT_NEAR(s.omega_rad_s, w, 1e-2);
  EXPECT_NEAR(std::remainder(s.yaw_rad - w * t, 2 * M_PI), 0.0, 1e-3);
}

// Variance of the filtered position over that of white noise: (2 g^2 + 2 h - 3 g h) / (g (4 - h - 2 g)) (Kalata 1984, "The
// tracking index"): 0.63 here.
TEST(RealField, NoiseIsReducedAsTheFiltersFormSays) {
  RealField real({});
  std::uint64_t state = 12345;
  double sum2 = 0.0, noise2 = 0.0;
  int count = 0;
  std::int64_t now_ns = 0;
  for (int n = 0; n < 40'000; ++n, now_ns += kFrame_ns) {
    double noise = 0.0;  // of nearly normal form: sum of twelve uniforms
    for (int k = 0; k < 12; ++k) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      noise += static_cast<double>(state >> 40) / 16777216.0 - 0.5;
    }
    noise *= 0.002;
    real.packet(frame({{4, noise, 0.0, 0.0}}), now_ns);
    const auto movers = real.movers(now_ns);
    ASSERT_EQ(movers.size(), 1u);
    if (n < 100) continue;
    sum2 += movers[0].state.x_m * movers[0].state.x_m;
    noise2 += noise * noise;
    ++count;
  }
  const double g = 0.75, h = 0.25;
  const double expected = (2 * g * g + 2 * h - 3 * g * h) / (g * (4 - h - 2 * g));
  EXPECT_NEAR(sum2 / noise2, expected, 0.03 * expected);
}

TEST(RealField, AJumpBeginsAnewAndSilenceIsTheEnd) {
  RealField real({});
  real.packet(frame({{4, 0.0, 0.0, 0.0}}), 0);
  real.packet(frame({{4, 0.01, 0.0, 0.0}}), kFrame_ns);
  EXPECT_GT(real.movers(kFrame_ns)[0].state.v_x_m_s, 0.1);
  real.packet(frame({{4, 2.0, 1.0, 0.0}}), 2 * kFrame_ns);
  const PlanarState s = real.movers(2 * kFrame_ns)[0].state;
  EXPECT_NEAR(s.x_m, 2.0, 1e-6);
  EXPECT_EQ(s.v_x_m_s, 0.0);
  EXPECT_EQ(real.movers(2 * kFrame_ns + 490'000'000).size(), 1u);
  EXPECT_EQ(real.movers(2 * kFrame_ns + 510'000'000).size(), 0u);
}

TEST(RealField, AFramesAgeIsTakenIntoAccount) {
  RealField real({});
  for (int n = 0; n < 60; ++n) {
    const std::int64_t now_ns = n * kFrame_ns;
    real.packet(frame({{4, 1e-9 * static_cast<double>(now_ns) - 0.02, 0.0, 0.0}}, {}, 0.02), now_ns);
  }
  const std::int64_t now_ns = 59 * kFrame_ns;
  EXPECT_NEAR(real.movers(now_ns)[0].state.x_m, 1e-9 * static_cast<double>(now_ns), 1e-4);
}

TEST(RealField, OneOfOursIsNotARealOne) {
  std::vector<LeagueRobot> ours(1);
  ours[0].team = Team::kYellow;
  ours[0].id = 4;
  RealField real(ours);
  real.packet(frame({{4, 0, 0, 0}, {5, 1, 0, 0}}), 0);
  EXPECT_EQ(real.robots(0).size(), 1u);
  EXPECT_EQ(real.robots(0)[0].id, 5);
  EXPECT_EQ(real.same_id(), 1u);
}

TEST(RealField, OfSeveralBallsTheOneWhereItShouldBe) {
  RealField real({});
  for (int n = 0; n < 30; ++n) real.packet(frame({}, {{3.0, 2.0 - n * 0.1}, {0.02 * n, 0.0}}), n * kFrame_ns);
  const auto ball = real.ball(29 * kFrame_ns);
  ASSERT_TRUE(ball);
  // Equal confidence: the first at first, and then the one that is near.
  EXPECT_NEAR(ball->position.x(), 3.0, 0.01);
  EXPECT_NEAR(ball->velocity.y(), -6.0, 0.1);
  EXPECT_NEAR(ball->spin.x(), 6.0 / 0.0215, 10.0);
  EXPECT_FALSE(real.ball(29 * kFrame_ns + 600'000'000));
}

TEST(RealField, WhatIsNoPacketIsSaid) {
  RealField real({});
  EXPECT_FALSE(real.packet("\xff\xff\xff", 0));
  std::string bytes = frame({{4, 1, 1, 0}});
  for (std::size_t cut = 1; cut < bytes.size(); ++cut) real.packet(bytes.substr(0, cut), 0);
  bytes = frame({{4, std::nan(""), 0, 0}}, {{std::nan(""), 0}});
  RealField clean({});
  EXPECT_TRUE(clean.packet(bytes, 0));
  EXPECT_TRUE(clean.movers(0).empty());
  EXPECT_FALSE(clean.ball(0));
}

}  // namespace
}  // namespace omnihil
