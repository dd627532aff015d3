// A robot of which the radio's commands are known and no duties: the model's controller closes the loop.
#include <cmath>

#include "hil/dataset/dataset_reader.h"
#include "identify/estimate/fit.h"
#include "identify/predict/predictor_robot.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {
namespace {

Candidate radio_candidate() {
  const std::string text = std::string(kRobotModel) + R"(
[controller]
kp_V_s_per_rad = { value = 0.03, tolerance = 0.2 }
ki_V_per_rad = { value = 0.3, tolerance = 0.2 }
feedforward_V_s_per_rad = 0.0335
speed_filter_s = 0.002
latency_s = { value = 0.02, tolerance = 0.5 }
acceleration_limit_m_s2 = 6.0
yaw_acceleration_limit_rad_s2 = 60.0
wheel_radius_m = 0.027
wheel_center_radius_m = 0.0805
)";
  const ModelReading reading = read_model(text, "model.toml", nullptr);
  for (const ModelProblem& p : reading.problems) ADD_FAILURE() << p.text();
  return candidate_of(*reading.model);
}

// Rows at 60 Hz: a command, four wheel speeds, gyro and camera in each.
Dataset blank_radio(double duration_s, bool wheels_commanded = false) {
  Dataset d;
  d.rig = Rig::kRobot;
  Run run;
  run.file = "drive.csv";
  const auto channel = [&](const std::string& signal, const char* unit, double sigma) {
    d.channels.push_back({.signal = signal, .column = signal, .unit = unit, .sigma = sigma});
  };
  const auto n = static_cast<std::size_t>(duration_s * 60.0);
  for (std::size_t k = 0; k < n; ++k) run.time_s.push_back(static_cast<double>(k) / 60.0);
  const auto asked = [&](const std::string& name, const char* unit, double size, double rate) {
    channel(name, unit, 0.0);
    for (const double t : run.time_s)
      run.signals[name].push_back(
          t < 0.3 ? 0.0 : size * std::copysign(1.0, std::sin(rate * t)) * (std::sin(0.7 * rate * t) > -0.5));
  };
  if (wheels_commanded) {
    for (int i = 1; i <= kWheels; ++i)
      asked("command_wheel_" + std::to_string(i), "rad/s", 20.0, 1.7 + 0.4 * i);
  } else {
    asked("command_vx", "m/s", 0.8, 2.1);
    asked("command_vy", "m/s", 0.6, 2.9);
    asked("command_w", "rad/s", 3.0, 1.3);
  }
  for (int i = 1; i <= kWheels; ++i) {
    channel("wheel_speed_" + std::to_string(i), "rad/s", 0.3);
    run.signals["wheel_speed_" + std::to_string(i)].assign(n, 0.0);
  }
  channel("gyro_z", "rad/s", 0.02);
  run.signals["gyro_z"].assign(n, 0.0);
  for (const char* name : {"vision_x", "vision_y", "vision_theta"}) {
    channel(name, name == std::string("vision_theta") ? "rad" : "m",
            name == std::string("vision_theta") ? 0.004 : 0.001);
    run.signals[name].assign(n, 0.0);
  }
  d.runs.push_back(run);
  d.runs.push_back(run);
  d.runs[1].split = Split::kValidation;
  return d;
}

TEST(RadioDriven, TheRobotGoesWhereItIsTold) {
  Dataset d = blank_radio(4.0);
  for (omnihil::Run& run : d.runs) {
    for (const char* axis : {"command_vx", "command_vy", "command_w"})
      run.signals[axis].assign(run.time_s.size(), 0.0);
    for (std::size_t k = 30; k < run.time_s.size(); ++k) run.signals["command_vx"][k] = 0.5;
  }
  const auto p = make_predictor(d, radio_candidate(), {});
  const Prediction y = p->predict(radio_candidate(), 0);
  ASSERT_TRUE(y.finite);
  // Settled: -sin(a) v / R at each wheel, but for what rolling without slip lets differ.
  const double angle[] = {55, 135, 225, 305};
  for (std::size_t s = 0; s < y.values.size(); ++s) {
    const std::string& name = p->compared(0)[s].name;
    if (!name.starts_with("wheel_speed_")) continue;
    const double a = angle[name.back() - '1'] * std::numbers::pi / 180.0;
    EXPECT_NEAR(y.values[s].back(), -std::sin(a) * 0.5 / 0.027, 0.05) << name;
  }
}

TEST(RadioDriven, TheModelThatMadeTheDataLeavesTheNoise) {
  for (const bool wheels : {false, true}) {
    const Candidate truth = radio_candidate();
    const auto p = make_predictor(blank_radio(8.0, wheels), truth, {})->simulated(truth, 3);
    const Prediction y = p->predict(truth, 0);
    for (std::size_t s = 0; s < p->compared(0).size(); ++s) {
      const ComparedSignal& c = p->compared(0)[s];
      double square = 0.0, count = 0.0;
      for (std::size_t k = 0; k < c.measured.size(); ++k) {
        const double r = c.measured[k] - y.values[s][k];
        if (std::isfinite(r)) square += r * r, count += 1.0;
      }
      EXPECT_NEAR(std::sqrt(square / count) / c.noise_sigma, 1.0, 0.15) << c.name << wheels;
    }
  }
}

// Through the loop: what a duty does to a speed comes back in the next duty.
TEST(RadioDriven, DerivativesAreExact) {
  Candidate at = with_effect(radio_candidate(), *find_effect("lateral_roller_friction"));
  at = with_effect(at, *find_effect("payload"));
  const auto p = make_predictor(blank_radio(2.0), at, {})->simulated(at, 5);
  const std::vector<Unknown> unknowns = unknowns_of(at);
  const Prediction d = p->predict_with_derivatives(at, unknowns, 0);
  std::vector<double> x;
  for (const Unknown& u : unknowns) x.push_back(u.start);
  for (std::size_t n = 0; n < unknowns.size(); ++n) {
    const double h = 1e-5 * std::max(std::abs(unknowns[n].scale), 1e-9);
    const auto moved = [&](double by) {
      std::vector<double> there = x;
      there[n] += by;
      return p->predict(with_values(at, unknowns, there), 0);
    };
    const Prediction up = moved(h), down = moved(x[n] - h < unknowns[n].lower ? 0.0 : -h);
    const double span = x[n] - h < unknowns[n].lower ? h : 2.0 * h;
    double error = 0.0, size = 0.0;
    for (std::size_t s = 0; s < up.values.size(); ++s) {
      const double noise = p->compared(0)[s].noise_sigma;
      for (std::size_t k = 0; k < up.values[s].size(); ++k) {
        const double expected = (up.values[s][k] - down.values[s][k]) / span / noise;
        const double got =
            d.derivatives[s](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(n)) / noise;
        if (!std::isfinite(expected)) continue;
        error += (got - expected) * (got - expected);
        size += expected * expected;
      }
    }
    // 1e-4 sigma of all samples together for a step that matters: the supply's voltage cancels in u / bus.
    EXPECT_LT(std::sqrt(error), 0.02 * std::sqrt(size) + 1e-4 / unknowns[n].scale) << unknowns[n].path;
  }
}

TEST(RadioDriven, AFitFindsLatencyAndGains) {
  const Candidate nominal = radio_candidate();
  Candidate truth = nominal;
  EXPECT_EQ(set_value(truth, "controller.latency_s", 0.031), "");
  EXPECT_EQ(set_value(truth, "controller.kp_V_s_per_rad", 0.036), "");
  EXPECT_EQ(set_value(truth, "robot.wheel_radius_m", 0.0274), "");
  const auto p = make_predictor(blank_radio(20.0), nominal, {})->simulated(truth, 11);
  const FitResult found_by = fit(*p, nominal, unknowns_of(nominal), {});
  const auto found = [&](const char* path) { return value_at(found_by.model, path).value_or(0.0); };
  EXPECT_NEAR(found("controller.latency_s"), 0.031, 0.0015);
  EXPECT_NEAR(found("controller.kp_V_s_per_rad"), 0.036, 0.004);
  EXPECT_NEAR(found("robot.wheel_radius_m"), 0.0274, 5e-5);
}

TEST(RadioDriven, TheDelayBelongsToTheController) {
  const auto p = make_predictor(blank_radio(1.0), radio_candidate(), {});
  EXPECT_EQ(p->applies(*find_effect("actuator_delay")), "the base model has controller.latency_s");
  EXPECT_EQ(p->applies(*find_effect("payload")), "");
  EXPECT_EQ(p->applies(*find_effect("encoder_eccentricity")), "needs encoders");
}

}  // namespace
}  // namespace omnihil::test
