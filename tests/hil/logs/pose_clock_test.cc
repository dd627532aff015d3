// Poses of another device on the robot's clock: lags that are known, frames that are turned, motions that are not one.
#include "hil/logs/pose_clock.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hil/logs/pose_join.h"
#include "identify/record/rig.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

using Complex = std::complex<double>;

// Ahead, aside, back, with rests: a velocity at any time.
Complex velocity(double t) {
  if (t < 1.0 || t > 9.0) return 0.0;
  return {0.4 * std::sin(0.9 * t), 0.3 * std::sin(1.7 * t + 0.4)};
}

MotionTrack robot(double noise_m_s, std::uint64_t seed = 1) {
  MotionTrack track;
  for (int k = 0; k <= 1000; ++k) {
    const auto n = static_cast<std::uint64_t>(k);
    track.time_s.push_back(0.01 * k);
    track.velocity_m_s.push_back(velocity(0.01 * k) +
                                 Complex(noise_m_s * gaussian(seed, 0, n), noise_m_s * gaussian(seed, 1, n)));
  }
  return track;
}

// A path seen at 60 Hz whose clock is `late` ahead, in a frame that is turned, at another scale.
MotionTrack camera(double late_s, double frame_rad, double scale) {
  std::vector<double> time_s;
  std::vector<Complex> place;
  Complex at = 0.0;
  for (int k = 0; k <= 20000; ++k) {
    at += velocity(1e-3 * k - 5.0) * 1e-3;  // begins 5 s before the robot's log does
    if (k % 16 != 0) continue;
    time_s.push_back(1e-3 * k - 5.0 + late_s);
    place.push_back(scale * at * std::polar(1.0, frame_rad));
  }
  return track_of_path(time_s, place, 0.1);
}

TEST(PoseClock, FindsLagFrameAndScaleUnderTheEncodersNoise) {
  for (const double late_s : {0.0, 2.173, -3.4}) {
    const PoseClock c = pose_clock(robot(0.5), camera(late_s, 0.3, 0.7));  // noise as large as the motion
    ASSERT_EQ(c.problem, "");
    EXPECT_NEAR(c.offset_s, late_s, 0.03);
    EXPECT_LT(c.sigma_s, 0.1);
    EXPECT_NEAR(c.frame_rad, 0.3, 0.05);
    EXPECT_NEAR(c.scale, 0.7, 0.07);
  }
}

// Of thirty draws the error in sigmas has an rms of 1, to within its own spread (1 / sqrt(2 * 30) = 0.13) thrice.
TEST(PoseClock, TheLagIsKnownToItsSigma) {
  double lag2 = 0.0, frame2 = 0.0;
  const MotionTrack seen = camera(1.7, 0.3, 0.7);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const PoseClock c = pose_clock(robot(0.5, seed), seen);
    ASSERT_EQ(c.problem, "");
    lag2 += std::pow((c.offset_s - 1.7) / c.sigma_s, 2);
    frame2 += std::pow((c.frame_rad - 0.3) / c.frame_sigma_rad, 2);
  }
  EXPECT_NEAR(std::sqrt(lag2 / 30.0), 1.0, 0.4);
  EXPECT_NEAR(std::sqrt(frame2 / 30.0), 1.0, 0.4);
}

// A circle driven at one speed looks the same later and turned: neither is known, and it says so.
TEST(PoseClock, ACircleTellsNoLagAndIsRefused) {
  MotionTrack circle, noisy;
  for (int k = 0; k <= 1000; ++k) {
    circle.time_s.push_back(0.01 * k);
    circle.velocity_m_s.push_back(0.4 * std::polar(1.0, 0.5 * 0.01 * k));
  }
  noisy = circle;
  for (std::size_t k = 0; k < noisy.time_s.size(); ++k)
    noisy.velocity_m_s[k] += Complex(0.1 * gaussian(1, 0, k), 0.1 * gaussian(1, 1, k));
  const PoseClock c = pose_clock(noisy, circle);
  EXPECT_GT(c.sigma_s, 1.0);
  EXPECT_NE(c.problem.find("at many lags"), std::string::npos) << c.problem;
}

TEST(PoseClock, IsExactWithoutNoise) {
  const PoseClock c = pose_clock(robot(0.0), camera(1.234, -2.0, 1.0));
  EXPECT_NEAR(c.offset_s, 1.234, 2e-3);
  EXPECT_NEAR(c.frame_rad, -2.0, 2e-3);
  EXPECT_NEAR(c.scale, 1.0, 0.02);  // the chord over 0.1 s and the mean over 0.2 s cut corners
}

TEST(PoseClock, AnotherDriveIsRefused) {
  std::vector<double> time_s;
  std::vector<Complex> place;
  for (int k = 0; k <= 1000; ++k) {
    time_s.push_back(0.01 * k);
    place.emplace_back(0.2 * std::sin(0.07 * k), 0.3 * std::cos(0.11 * k));
  }
  const PoseClock c = pose_clock(robot(0.0), track_of_path(time_s, place, 0.1));
  EXPECT_NE(c.problem.find("do not tell one motion"), std::string::npos) << c.correlation;
}

LogTable table(std::vector<LogSeries> series) {
  LogTable t;
  t.series = std::move(series);
  return t;
}

// A robot that does not turn, and a camera that sees it in a frame turned by `frame_rad`, its clock 3 s ahead.
struct Drive {
  explicit Drive(double frame_rad = 0.0) {
    g.wheels.wheels = 3;
    for (std::size_t i = 0; i < 3; ++i) {
      const double a = std::array{2.6179938779914944, 4.71238898038469, 0.5235987755982988}[i];
      g.wheels.cos_angle[i] = std::cos(a);
      g.wheels.sin_angle[i] = std::sin(a);
    }
    g.wheels.wheel_center_radius_m = 0.08;
    g.wheels.wheel_radius_m = 0.025;
    log.resize(6), pose.resize(4);
    const char* names[] = {"t", "w1", "w2", "w3", "u1", "heading"};
    for (std::size_t s = 0; s < log.size(); ++s) log[s].name = names[s];
    const char* pose_names[] = {"when", "px", "py", "turn"};
    for (std::size_t s = 0; s < pose.size(); ++s) pose[s].name = pose_names[s];
    Complex at = 0.0;
    for (int k = 0; k <= 1000; ++k) {
      const double t = 0.01 * k;
      log[0].value.push_back(t);
      const auto w = wheel_speeds<double>(g.wheels, {velocity(t).real(), velocity(t).imag(), 0.0});
      for (std::size_t i = 0; i < 3; ++i) log[1 + i].value.push_back(w[i]);
      log[4].value.push_back(0.0);
      log[5].value.push_back(0.0);
      for (int j = 0; j < 10; ++j) at += velocity(0.01 * k + 1e-3 * j) * 1e-3;
      place.push_back(at);
      const Complex seen = at * std::polar(1.0, frame_rad);
      pose[0].value.push_back(t + 3.0);
      pose[1].value.push_back(seen.real());
      pose[2].value.push_back(seen.imag());
      pose[3].value.push_back(frame_rad);
    }
    std::vector<std::string> faults;
    for (const char* map :
         {"t=time:s", "w1=wheel_speed_1:rad/s", "w2=wheel_speed_2:rad/s", "w3=wheel_speed_3:rad/s",
          "u1=duty_1:%", "when=time:s", "px=vision_x:m", "py=vision_y:m"})
      asked.push_back(parse_map(map, faults));
    EXPECT_TRUE(faults.empty());
  }
  void ask(const char* map) {
    std::vector<std::string> faults;
    asked.push_back(parse_map(map, faults));
  }
  JoinedPose joined() const {
    MeaningContext context;
    context.rig = &rig_robot();
    return join_pose(table(log), table(pose), asked, g, context, "drive.csv", "video.csv");
  }
  // Within two rows of 0.4 m/s, and as many of them as there are.
  void expect_places(const JoinedPose& j) const {
    const std::vector<double>&x = series(j, "pose_vision_x"), &y = series(j, "pose_vision_y");
    ASSERT_EQ(x.size(), 1001u);
    int seen = 0;
    for (std::size_t k = 100; k < 900; ++k) {
      if (!std::isfinite(x[k])) continue;
      ++seen;
      EXPECT_NEAR(x[k], place[k].real(), 0.012) << k;
      EXPECT_NEAR(y[k], place[k].imag(), 0.012) << k;
    }
    EXPECT_GE(seen, 600);
  }
  static const std::vector<double>& series(const JoinedPose& j, const std::string& name) {
    static const std::vector<double> none;
    for (const LogSeries& s : j.table.series) {
      if (s.name == name) return s.value;
    }
    return none;
  }

  PoseGeometry g;
  std::vector<LogSeries> log, pose;
  std::vector<Complex> place;
  std::vector<ColumnMap> asked;
};

TEST(PoseJoin, PosesStandAtTheRowsTheyWereTakenAt) {
  Drive d;
  const JoinedPose joined = d.joined();
  ASSERT_EQ(joined.columns, (std::vector<std::string>{"pose_vision_x", "pose_vision_y"}));
  d.expect_places(joined);
  EXPECT_NE(joined.note.find(" s ahead (correlation 1.00)"), std::string::npos) << joined.note;
  // what no wheel told cannot be lined up
  d.log.erase(d.log.begin() + 2);
  EXPECT_THROW(d.joined(), BadLog);
}

TEST(PoseJoin, AFrameWithoutTheRobotIsNoReasonToRefuseTheOthers) {
  Drive d;
  for (std::size_t k = 0; k < d.pose[1].value.size(); k += 5)
    d.pose[1].value[k] = d.pose[2].value[k] = std::nan("");
  d.expect_places(d.joined());
}

// Place and heading have to be of one frame.
TEST(PoseJoin, PlacesAreTurnedIntoTheFrameOfTheHeadingThatIsKept) {
  Drive d(0.5);
  d.ask("turn=vision_theta:rad");
  const JoinedPose of_camera = d.joined();
  ASSERT_EQ(of_camera.columns.size(), 3u);
  EXPECT_EQ(Drive::series(of_camera, "pose_vision_theta")[500], 0.5);
  EXPECT_NEAR(Drive::series(of_camera, "pose_vision_x")[500], (d.place[500] * std::polar(1.0, 0.5)).real(),
              0.012);
  d.ask("heading=vision_theta:rad");
  const JoinedPose of_robot = d.joined();
  ASSERT_EQ(of_robot.columns.size(), 2u);
  d.expect_places(of_robot);
}

}  // namespace
}  // namespace omnihil
