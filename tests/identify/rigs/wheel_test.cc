// One wheel under a body that the bench moves.
#include <gtest/gtest.h>

#include <cmath>

#include "identify/compare/comparison.h"
#include "identify/estimate/fit.h"
#include "identify/record/rig.h"
#include "sim/law/effect_registry.h"
#include "sim/model/rolling_model.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr const char* kTyre = R"(
[tyre.longitudinal]
extremum_slip = { value = 0.1, tolerance = 0.2 }
extremum_value = { value = 0.5, tolerance = 0.2 }
asymptote_slip = 0.4
asymptote_value = { value = 0.35, tolerance = 0.2 }
[tyre.lateral]
extremum_slip = 0.1
extremum_value = 0.09
asymptote_slip = 0.3
asymptote_value = 0.07
)";

Candidate model(bool tyre) {
  std::string text = kRobotModel;
  text = text.substr(0, text.find("[effects"));  // without dry friction: forces in closed form
  const ModelReading reading = read_model(text + (tyre ? kTyre : ""), "model.toml", nullptr);
  for (const ModelProblem& p : reading.problems) ADD_FAILURE() << p.text();
  return candidate_of(*reading.model);
}

Dataset bench(double duration_s, double (*duty)(double), double (*vx)(double), double vy) {
  Dataset d;
  d.rig = find_rig("wheel");
  Run run;
  run.file = "drive.csv";
  const auto n = static_cast<std::size_t>(duration_s * 1000.0);
  for (std::size_t k = 0; k < n; ++k) {
    run.time_s.push_back(1e-3 * static_cast<double>(k));
    run.signals["duty"].push_back(duty(run.time_s.back()));
    run.signals["body_vx"].push_back(vx(run.time_s.back()));
    run.signals["body_vy"].push_back(vy);
  }
  const auto channel = [&](const char* name, double sigma, double counts, bool imposed) {
    Channel& c = d.channels.emplace_back();
    c.signal = c.column = name;
    c.sigma = sigma;
    c.counts_per_rev = counts;
    c.imposed = imposed;
    run.signals[name].resize(n);
  };
  channel("duty", 0.0, 0.0, false);
  channel("body_vx", 0.0, 0.0, true);
  channel("body_vy", 0.0, 0.0, true);
  channel("encoder", 0.0, 16384.0, false);
  channel("motor_current", 0.03, 0.0, false);
  channel("force_x", 0.05, 0.0, false);
  channel("force_y", 0.05, 0.0, false);
  d.runs.push_back(run);
  return d;
}

std::vector<double> of(const Predictor& p, const Candidate& c, const std::string& name) {
  const Prediction y = p.predict(c, 0);
  EXPECT_TRUE(y.finite);
  for (std::size_t s = 0; s < y.values.size(); ++s) {
    if (p.compared(0)[s].name == name) return y.values[s];
  }
  ADD_FAILURE() << name;
  return {0.0};
}

constexpr double kRadius_m = 0.027, kGear = 3.0, kMass_kg = 2.4, kGravity = 9.80665;

// A wheel that rolls under a body at 0.8 m/s turns at v N / r, and pushes with what its winding makes there:
// F = N (k (u U - k w) / R - b w) / r.
TEST(PredictorWheel, AWheelThatRollsPushesWithItsMotorsTorque) {
  const Candidate c = model(false);
  const auto p = make_predictor(bench(
                                    1.0, [](double) { return 0.25; }, [](double) { return 0.8; }, 0.0),
                                c, {});
  const double omega = 0.8 * kGear / kRadius_m;
  const double current_A = (0.25 * 22.2 - 0.0335 * omega) / 0.464;
  EXPECT_NEAR(of(*p, c, "velocity").back(), omega, 1e-4 * omega);
  EXPECT_NEAR(of(*p, c, "motor_current").back(), current_A, 1e-3 * std::abs(current_A));
  EXPECT_NEAR(of(*p, c, "force_x").back(), kGear * (0.0335 * current_A - 4e-6 * omega) / kRadius_m, 5e-3);
  EXPECT_NEAR(of(*p, c, "force_y").back(), 0.0, 1e-12);
}

// Spun up under a body that stands, a tyre pushes with its asymptote of a quarter of the robot's weight.
TEST(PredictorWheel, ASpinningTyrePushesWithItsShareOfTheWeight) {
  const Candidate c = model(true);
  const auto p = make_predictor(bench(
                                    1.0, [](double) { return 0.9; }, [](double) { return 0.0; }, 0.5),
                                c, {});
  const double load_N = kMass_kg * kGravity / 4.0;
  EXPECT_NEAR(of(*p, c, "force_x").back(), 0.35 * load_N, 1e-6);
  EXPECT_NEAR(of(*p, c, "force_y").back(), -0.07 * load_N, 1e-6);  // rollers dragged to the left pull back
}

// Whatever its wheel does, the body is where the bench has it: a coasting wheel's force on it is its own inertia's.
TEST(PredictorWheel, ABodyThatIsPulledAlongDragsTheWheelsInertia) {
  const Candidate c = model(false);
  Dataset d = bench(
      1.0, [](double) { return 0.0; }, [](double t) { return 2.0 * t; }, 0.0);
  d.channels.emplace_back().signal = "enable";
  d.runs[0].signals["enable"].assign(1000, 0.0);
  const auto p = make_predictor(d, c, {});
  // F r / N = -(J w' + b w) at the rotor
  const double inertia = 1.35e-5 + 2.2e-5 / (kGear * kGear), per_m_s = kGear / kRadius_m;
  const double expected_N = -per_m_s * (inertia * 2.0 + 4e-6 * 2.0 * 0.9) * per_m_s;
  EXPECT_NEAR(of(*p, c, "force_x")[900], expected_N, 0.01 * std::abs(expected_N));
}

TEST(PredictorWheel, DerivativesAreThoseOfTheModel) {
  const Candidate c = model(true);
  const auto p = make_predictor(bench(
                                    0.5, [](double t) { return 0.25 + 0.1 * std::sin(9.0 * t); },
                                    [](double t) { return 0.6 + 0.2 * t; }, 0.1),
                                c, {});
  const std::vector<Unknown> unknowns = unknowns_of(c);
  const Prediction y = p->predict_with_derivatives(c, unknowns, 0);
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const double at = unknowns[u].start, h = 1e-5 * std::max(std::abs(at), 1e-3);
    const double up = at + h, down = at - h;
    const Prediction a = p->predict(with_values(c, std::span(&unknowns[u], 1), std::span(&up, 1)), 0);
    const Prediction b = p->predict(with_values(c, std::span(&unknowns[u], 1), std::span(&down, 1)), 0);
    for (std::size_t s = 0; s < y.values.size(); ++s) {
      double off = 0.0, size = 0.0;
      for (std::size_t k = 1; k < y.values[s].size(); ++k) {
        const double d = (a.values[s][k] - b.values[s][k]) / (2.0 * h);
        const double exact = y.derivatives[s](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(u));
        off += (d - exact) * (d - exact), size += d * d;
      }
      EXPECT_LE(std::sqrt(off), 0.01 * std::sqrt(size) + 1e-5 / std::max(std::abs(at), 1e-3))
          << unknowns[u].path << " " << p->compared(0)[s].name;
    }
  }
}

// Load cell and encoder tell the tyre: a grip that is 20 % off is found to 2 %.
TEST(PredictorWheel, AFitFindsTheGrip) {
  const Candidate nominal = model(true);
  Candidate truth = nominal;
  ASSERT_EQ(set_value(truth, "tyre.longitudinal.extremum_value", 0.6), "");
  ASSERT_EQ(set_value(truth, "tyre.longitudinal.asymptote_value", 0.42), "");
  const Dataset d = bench(
      4.0, [](double t) { return 0.25 + 0.5 * std::sin(3.0 * t); }, [](double) { return 0.8; }, 0.0);
  const auto p = make_predictor(d, nominal, {})->simulated(truth, 5);
  const FitResult fitted = fit(*p, nominal, unknowns_of(nominal), {});
  for (const char* path : {"tyre.longitudinal.extremum_value", "tyre.longitudinal.asymptote_value"})
    EXPECT_NEAR(*value_at(fitted.model, path), *value_at(truth, path), 0.02 * *value_at(truth, path)) << path;
}

TEST(PredictorWheel, WhatMovesABodyIsRefused) {
  const Candidate c = model(true);
  const auto p = make_predictor(bench(
                                    0.1, [](double) { return 0.0; }, [](double) { return 0.0; }, 0.0),
                                c, {});
  EXPECT_EQ(p->applies(*find_effect("payload")), "the bench moves the body, whatever forces do");
  EXPECT_EQ(p->applies(*find_effect("motor_mismatch")), "needs more than one motor");
  EXPECT_EQ(p->applies(*find_effect("wheel_slip")), "");
  EXPECT_EQ(p->applies(*find_effect("cogging")), "");
}

}  // namespace
}  // namespace omnihil::test
