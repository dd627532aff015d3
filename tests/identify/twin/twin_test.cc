// The live twin's parts in closed form, and on robots that its own model simulates.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "identify/predict/predictor.h"
#include "identify/record/rig.h"
#include "identify/twin/twin_watch.h"
#include "sim/model/rolling_model.h"
#include "tests/identify/simulated_radio.h"

namespace omnihil::test {
namespace {

TEST(TwoTerms, FindsWhatIsConstantAndWhatGrows) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> x, z;
  for (int k = 0; k < 20000; ++k) {
    x.push_back(0.01 * (k % 500));
    z.push_back((2.0 + 3.0 * x.back()) * std::pow(normal(random), 2));
  }
  const auto [a, b] = two_terms(x, z);
  EXPECT_NEAR(a, 2.0, 0.2);  // sqrt(2 / n) of a square, times what two terms cost
  EXPECT_NEAR(b, 3.0, 0.2);
}

TEST(TwoTerms, IsNeverNegative) {
  const auto [a, b] = two_terms({0.0, 1.0, 2.0, 3.0}, {4.0, 3.0, 2.0, 1.0});
  EXPECT_GT(a, 0.0);
  EXPECT_EQ(b, 0.0);
}

// A drive at 60 Hz, simulated from `at_s` on by a model with `path` at `value`; told with noise, cut into pieces.
class Drive {
 public:
  Drive(double seconds, double at_s, const std::string& path, double value) {
    const Candidate healthy = radio_candidate();
    const TwinBank bank = twin_bank(healthy);
    const Dataset d = blank_radio(seconds);
    run_ = d.runs[0];
    for (const char* name : {"vision_x", "vision_y", "vision_theta"}) run_.signals.erase(name);
    Candidate broken = bank.model;
    if (!path.empty()) {
      EXPECT_EQ(set_value(broken, path, value), "");
    }
    simulate(bank.model, broken, at_s);
  }
  void stop_line(const std::string& name, double at_s) {
    for (std::size_t k = 0; k < run_.time_s.size(); ++k) {
      if (run_.time_s[k] >= at_s) run_.signals[name][k] = 0.0;
    }
  }
  std::vector<TwinAlarm> watched(const TwinOptions& options) const {
    TwinModel model(twin_bank(radio_candidate()));
    TwinWatch watch(model.bank(), options);
    std::vector<TwinAlarm> alarms;
    for (std::size_t first = 0; first + 30 < run_.time_s.size(); first += 30) {
      if (const auto alarm = watch.take(model.advance(piece(first, first + 30)))) alarms.push_back(*alarm);
    }
    EXPECT_FALSE(watch.learning());
    return alarms;
  }

 private:
  omnihil::Run piece(std::size_t first, std::size_t last) const {
    omnihil::Run out;
    const auto cut = [&](const std::vector<double>& v) {
      return std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(first),
                                 v.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    };
    out.time_s = cut(run_.time_s);
    for (const auto& [name, values] : run_.signals) out.signals[name] = cut(values);
    return out;
  }
  void simulate(const Candidate& healthy, const Candidate& broken, double at_s) {
    Dataset d;
    d.rig = &rig_robot();
    const auto nominal = rolling_params(healthy.file.parameters);
    const auto before = rolling_values<double>({healthy}), after = rolling_values<double>({broken});
    RobotCarry<double> carry;
    std::mt19937_64 random(7);
    std::normal_distribution<double> noise;
    const omnihil::Run asked = run_;
    for (std::size_t first = 0; first + 30 < asked.time_s.size(); first += 30) {
      const omnihil::Run part = piece(first, first + 30);
      const RobotMotionOptions options{.slave_angle = false, .follow_camera = false, .noise_seed = {}};
      const auto m = run_robot(asked.time_s[first] < at_s ? before : after, robot_record(d, part, nominal),
                               options, &carry);
      for (std::size_t k = 0; k <= 30; ++k) {
        for (std::size_t i = 0; i < kWheels; ++i)
          told_["wheel_speed_" + std::to_string(i + 1)].resize(asked.time_s.size());
        for (std::size_t i = 0; i < kWheels; ++i)
          told_["wheel_speed_" + std::to_string(i + 1)][first + k] =
              m.samples[k].wheel_rad_s[i] + 0.05 * noise(random);
        told_["gyro_z"].resize(asked.time_s.size());
        told_["gyro_z"][first + k] = m.samples[k].gyro_rad_s + 0.01 * noise(random);
      }
    }
    for (const auto& [name, values] : told_) run_.signals[name] = values;
  }
  omnihil::Run run_;
  std::map<std::string, std::vector<double>> told_;
};

constexpr TwinOptions kQuick{.learn_s = 20.0};

TEST(TwinWatch, AHealthyRobotRaisesNoAlarm) {
  for (const TwinAlarm& alarm : Drive(120.0, 0.0, "", 0.0).watched(kQuick)) ADD_FAILURE() << alarm.sentence;
}

struct Broken {
  const char* path;
  double value;
  const char* suspect;
};

TEST(TwinWatch, EachFaultOfItsBankIsNamedWithItsSizeWithinFiveSeconds) {
  for (const Broken& b : {Broken{"wheel_torque.wheel_2", -0.2, "torque of wheel 2"},
                          Broken{"motor_mismatch.ratio_4", 0.8, "torque of wheel 4"},
                          Broken{"wheel_drag.wheel_3_Nm", 0.03, "drag on wheel 3"},
                          Broken{"payload.mass_kg", 0.8, "more mass to move"}}) {
    const auto alarms = Drive(60.0, 40.0, b.path, b.value).watched(kQuick);
    ASSERT_FALSE(alarms.empty()) << b.path;
    EXPECT_EQ(alarms[0].suspect, b.suspect) << alarms[0].sentence;
    EXPECT_GE(alarms[0].time_s, 40.0) << alarms[0].sentence;
    EXPECT_LE(alarms[0].time_s, 45.0) << alarms[0].sentence;
  }
}

TEST(TwinWatch, ALineThatTellsZerosIsNamed) {
  Drive drive(60.0, 0.0, "", 0.0);
  drive.stop_line("wheel_speed_3", 40.0);
  const auto alarms = drive.watched(kQuick);
  ASSERT_FALSE(alarms.empty());
  EXPECT_EQ(alarms[0].fault, "encoder_line_3") << alarms[0].sentence;
  EXPECT_LE(alarms[0].time_s, 45.0);
}

TEST(TwinWatch, ARobotWhoseWheelsAllStandIsNoDeadLine) {
  Drive drive(60.0, 0.0, "", 0.0);
  for (int i = 1; i <= 4; ++i) drive.stop_line("wheel_speed_" + std::to_string(i), 40.0);
  const auto alarms = drive.watched(kQuick);
  ASSERT_FALSE(alarms.empty());
  EXPECT_EQ(alarms[0].fault, "robot stands") << alarms[0].sentence;
}

TEST(TwinWatch, WhatIsInNoBankIsToldAndNotNamed) {
  const auto alarms = Drive(60.0, 40.0, "robot.wheel_radius_m", 0.025).watched(kQuick);
  ASSERT_FALSE(alarms.empty());
  for (const TwinAlarm& a : alarms) EXPECT_EQ(a.fault, "unknown") << a.sentence;
}

// Half of a fault's least size never adds up, however long it lasts: no alarm, by the sum's own law.
TEST(TwinWatch, LessThanHalfAFaultsLeastSizeNeverAddsUp) {
  for (const TwinAlarm& a : Drive(120.0, 40.0, "wheel_torque.wheel_2", -0.03).watched(kQuick))
    ADD_FAILURE() << a.sentence;
}

}  // namespace
}  // namespace omnihil::test
