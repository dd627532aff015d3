// What the robot's model says its sensors would have shown.
#include <cstdlib>

#include "hil/dataset/dataset_reader.h"
#include "identify/compare/comparison.h"
#include "identify/estimate/fit.h"
#include "identify/estimate/null_model.h"
#include "identify/predict/predictor.h"
#include "sim/law/scalar.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {
namespace {

std::unique_ptr<Predictor> simulated_recording(const Candidate& truth, bool bus = true,
                                               double duration_s = 8.0) {
  return make_predictor(blank_robot(duration_s, bus), robot_candidate(), {})->simulated(truth, 7);
}

// Root mean square of whitened residuals over the noise, per signal.
std::map<std::string, double> errors(const Predictor& p, const Candidate& c, int run = 0) {
  std::map<std::string, double> out;
  const Prediction y = p.predict(c, run);
  for (std::size_t s = 0; s < p.compared(run).size(); ++s) {
    const ComparedSignal& signal = p.compared(run)[s];
    std::vector<double> r(signal.measured.size());
    for (std::size_t k = 0; k < r.size(); ++k) r[k] = signal.measured[k] - y.values[s][k];
    double square = 0.0, count = 0.0;
    for (const double v : whitened(signal, r)) {
      if (std::isfinite(v)) square += v * v, count += 1.0;
    }
    out[signal.name] = std::sqrt(square / count) / signal.whitened_sigma;
  }
  return out;
}

Candidate with_typical(Candidate c, const std::vector<std::string>& effects) {
  for (const std::string& id : effects) {
    c = with_effect(c, *find_effect(id));
    const DriveParams<double> drive = drive_of(c);
    c.effects.back() = typical_use(*find_effect(id), &drive);
  }
  return c;
}

TEST(PredictorRobot, TheModelThatMadeTheDataLeavesTheNoise) {
  for (const bool bus : {false, true}) {
    const Candidate truth =
        with_typical(robot_candidate(), {"cogging", "lateral_roller_friction", "floor_tilt"});
    const auto simulated = simulated_recording(truth, bus);
    for (const auto& [signal, error] : errors(*simulated, truth)) {
      EXPECT_NEAR(error, 1.0, 0.15) << signal << ", bus measured: " << bus;
    }
  }
}

// A robot whose motors differ departs by metres from the path of a model without that effect. The null's mean
// square of that model is the sensors' noise nevertheless, since its pose inputs are those of each replicate.
TEST(PredictorRobot, TheNullIsTheSensorsNoiseHoweverFarThePathDeparts) {
  const Candidate nominal = robot_candidate(), truth = with_typical(nominal, {"motor_mismatch"});
  const auto strayed = simulated_recording(truth, false);
  ASSERT_GT(errors(*strayed, nominal)["vision_theta"], 3.0);
  const ComparedChannels channels = compared_channels(*strayed);
  const std::array<WhitenedResiduals, kSplits> splits{
      WhitenedResiduals(*strayed, channels, Split::kTraining),
      WhitenedResiduals(*strayed, channels, Split::kValidation),
      WhitenedResiduals(*strayed, channels, Split::kExtrapolation)};
  const NullModel null = simulate_null(*strayed, nominal, splits, 3, 3, 2);
  for (int k = 0; k < channels.count(); ++k) {
    const auto n = static_cast<std::size_t>(k);
    EXPECT_NEAR(std::sqrt(null.floor(Split::kTraining)[k]) / channels.noise_sigma[n], 1.0, 0.15)
        << channels.name[n];
  }
}

TEST(PredictorRobot, EveryEffectThatAppliesShows) {
  const Candidate nominal = robot_candidate();
  for (const EffectEntry* entry : all_effects()) {
    const std::string id(entry->info->id);
    if (id == "coulomb_friction" || id == "expression") continue;
    if (id == "duty_limit" || id == "thermal_derating") continue;  // beyond these duties, beyond this warmth
    if (id == "sample_jitter") continue;                           // no expected value: noise_effect_test.cc
    const bool needs_supply = entry->info->place == Place::kSupply;
    const auto nothing = simulated_recording(nominal, !needs_supply, 2.0);
    if (!nothing->applies(*entry).empty()) continue;
    const Prediction base = nothing->predict(nominal, 0);
    const Prediction with = nothing->predict(with_typical(nominal, {id}), 0);
    double largest = 0.0;
    for (std::size_t s = 0; s < base.values.size(); ++s) {
      for (std::size_t k = 0; k < base.values[s].size(); ++k) {
        const double d =
            std::abs(with.values[s][k] - base.values[s][k]) / nothing->compared(0)[s].noise_sigma;
        if (std::isfinite(d)) largest = std::max(largest, d);
      }
    }
    EXPECT_GT(largest, 1e-3) << id;
  }
}

TEST(PredictorRobot, AnEffectAtNeutralChangesNoBit) {
  const Candidate nominal = robot_candidate();
  const auto simulated = simulated_recording(nominal, false, 1.0);
  const Prediction base = simulated->predict(nominal, 0);
  for (const EffectEntry* entry : all_effects()) {
    if (entry->info->id == "expression" || !simulated->applies(*entry).empty()) continue;
    const Prediction with = simulated->predict(with_effect(nominal, *entry), 0);
    for (std::size_t s = 0; s < base.values.size(); ++s) {
      for (std::size_t k = 1; k < base.values[s].size(); ++k) {
        if (std::isnan(base.values[s][k])) continue;
        ASSERT_EQ(with.values[s][k], base.values[s][k]) << entry->info->id;
      }
    }
  }
}

// How far derivatives are from central differences, over these: the largest of all unknowns'.
double off_differences(const Predictor& p, const Candidate& at, const std::vector<Unknown>& unknowns) {
  const Prediction d = p.predict_with_derivatives(at, unknowns, 0);
  std::vector<double> x;
  for (const Unknown& u : unknowns) x.push_back(u.start);
  double largest = 0.0;
  for (std::size_t n = 0; n < unknowns.size(); ++n) {
    const double h = 1e-5 * std::max(std::abs(unknowns[n].scale), 1e-9);
    const auto moved = [&](double by) {
      std::vector<double> there = x;
      there[n] += by;
      return p.predict(with_values(at, unknowns, there), 0);
    };
    const Prediction up = moved(h), down = moved(-h);
    double error = 0.0, size = 0.0;
    for (std::size_t s = 0; s < up.values.size(); ++s) {
      const double noise = p.compared(0)[s].noise_sigma;
      for (std::size_t k = 0; k < up.values[s].size(); ++k) {
        const double expected = (up.values[s][k] - down.values[s][k]) / (2.0 * h) / noise;
        const double got =
            d.derivatives[s](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(n)) / noise;
        if (!std::isfinite(expected)) continue;
        error += (got - expected) * (got - expected);
        size += expected * expected;
      }
    }
    const double off = std::sqrt(error) / (std::sqrt(size) + 1e-7);
    EXPECT_TRUE(std::isfinite(off)) << unknowns[n].path;
    largest = std::max(largest, off);
  }
  return largest;
}

// Against central differences, away from kinks: a wheel that stops at another instant is one.
TEST(PredictorRobot, DerivativesAreExact) {
  const Candidate at =
      with_typical(robot_candidate(), {"wheel_slip", "lateral_roller_friction", "rolling_resistance",
                                       "payload", "vision_delay", "center_of_mass_offset", "battery_sag",
                                       "winding_heating", "motor_mismatch", "floor_tilt"});
  const auto simulated = simulated_recording(at, false, 1.0);
  EXPECT_LT(off_differences(*simulated, at, unknowns_of(at)), 0.01);
}

constexpr const char* kTyre = R"(
[tyre.longitudinal]
extremum_slip = { value = 0.1, tolerance = 0.2 }
extremum_value = 0.75
asymptote_slip = 0.4
asymptote_value = 0.6
[tyre.lateral]
extremum_slip = 1.0
extremum_value = { value = 0.02, tolerance = 0.3 }
asymptote_slip = 2.0
asymptote_value = 0.01
)";

// On tyres derivatives are those of steps twice as long, values are not; more unknowns than one pass has room for.
TEST(PredictorRobot, OnTyresValuesBesideDerivativesAreThePredicted) {
  const ModelReading reading = read_model(std::string(kRobotModel) + kTyre, "model.toml", nullptr);
  ASSERT_TRUE(reading.model);
  const Candidate at = candidate_of(*reading.model);
  const std::vector<Unknown> unknowns = unknowns_of(at);
  ASSERT_GT(unknowns.size(), static_cast<std::size_t>(kJetWidth));
  const auto simulated = simulated_recording(at, false, 1.0);
  EXPECT_TRUE(simulated->is_costly());
  const Prediction alone = simulated->predict(at, 0);
  const Prediction beside = simulated->predict_with_derivatives(at, unknowns, 0);
  for (std::size_t s = 0; s < alone.values.size(); ++s) {
    for (std::size_t k = 0; k < alone.values[s].size(); ++k) {
      if (std::isnan(alone.values[s][k])) continue;
      ASSERT_EQ(alone.values[s][k], beside.values[s][k]);
    }
  }
  EXPECT_LT(off_differences(*simulated, at, unknowns), 0.05);  // a Gauss-Newton step as good as by the exact
}

TEST(PredictorRobot, ALateCameraIsSeenInThePoseAlone) {
  const auto simulated = simulated_recording(with_typical(robot_candidate(), {"vision_delay"}));
  const auto error = errors(*simulated, robot_candidate());
  EXPECT_GT(std::max(error.at("vision_x"), error.at("vision_y")), 3.0);
  EXPECT_NEAR(error.at("velocity_1"), 1.0, 0.1);
  EXPECT_NEAR(error.at("gyro_z"), 1.0, 0.1);
}

TEST(PredictorRobot, WhatCannotActSaysWhy) {
  const auto simulated = simulated_recording(robot_candidate(), true, 0.5);
  for (const char* id : {"backlash", "hall_speed_estimator", "target_speed_limit", "dribbler_drag"}) {
    EXPECT_NE(simulated->applies(*find_effect(id)), "") << id;
  }
  for (const char* id : {"wheel_slip", "cogging", "vision_delay", "floor_tilt"}) {
    EXPECT_EQ(simulated->applies(*find_effect(id)), "") << id;
  }
}

// A recording of a robot by a simulator that shares nothing with this one.
TEST(PredictorRobot, SlowAnIndependentRobotIsExplainedToItsNoise) {
  const char* shared = std::getenv("OMNIHIL_SHARED");
  if (shared == nullptr) GTEST_SKIP() << "OMNIHIL_SHARED is not set";
  const DatasetReading reading = read_dataset(std::string(shared) + "/data/robot_sample");
  for (const ModelProblem& p : reading.problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(reading.dataset);
  const auto predictor = make_predictor(*reading.dataset, *reading.nominal, {});
  const FitResult r = fit(*predictor, *reading.nominal, unknowns_of(*reading.nominal), {.jobs = 2});
  for (int run = 0; run < predictor->run_count(); ++run) {
    const Prediction y = predictor->predict(r.model, run);
    for (std::size_t s = 0; s < y.values.size(); ++s) {
      const ComparedSignal& signal = predictor->compared(run)[s];
      double square = 0.0, count = 0.0;
      for (std::size_t k = 0; k < y.values[s].size(); ++k) {
        const double e = signal.measured[k] - y.values[s][k];
        if (std::isfinite(e)) square += e * e, count += 1.0;
      }
      EXPECT_LT(std::sqrt(square / count), 1.1 * signal.noise_sigma) << run << " " << signal.name;
    }
  }
}

// A bench that turns the whole robot at 2 rad/s: each wheel rolls at R_b w / r, whatever its motor does, and what would move
// the body is refused.
TEST(PredictorRobot, ABodyThatIsMovedTurnsItsWheels) {
  Dataset d = blank_robot(1.0, true);
  for (const char* name : {"body_vx", "body_vy", "body_w"}) {
    d.channels.emplace_back().signal = name;
    d.channels.back().imposed = true;
    for (auto& run : d.runs)
      run.signals[name].assign(run.time_s.size(), name == std::string("body_w") ? 2.0 : 0.0);
  }
  const Candidate c = robot_candidate();
  const auto p = make_predictor(d, c, {});
  const Prediction y = p->predict(c, 0);
  for (std::size_t s = 0; s < y.values.size(); ++s) {
    if (!p->compared(0)[s].name.starts_with("velocity")) continue;
    EXPECT_NEAR(y.values[s].back(), 3.0 * 2.0 * 0.0805 / 0.027, 0.01) << p->compared(0)[s].name;
  }
  EXPECT_EQ(p->applies(*find_effect("floor_tilt")), "the bench moves the body, whatever forces do");
  EXPECT_EQ(make_predictor(blank_robot(1.0, true), c, {})->applies(*find_effect("floor_tilt")), "");
}

const ComparedSignal& signal_of(const Predictor& p, const std::string& name) {
  for (const ComparedSignal& c : p.compared(0)) {
    if (c.name == name) return c;
  }
  ADD_FAILURE() << name;
  return p.compared(0).front();
}

// As of an axis: v_k = (x_k - x_j) / (t_k - t_j), j the last counted row.
TEST(PredictorRobot, AMissingRowOfAnEncoderCostsItselfAlone) {
  Dataset d = blank_robot(0.5, false);
  std::vector<double>& counts = d.runs[0].signals["encoder_1"];
  for (std::size_t k = 0; k < counts.size(); ++k) counts[k] = 3.0 * static_cast<double>(k);
  counts[200] = std::numeric_limits<double>::quiet_NaN();
  const auto p = make_predictor(d, robot_candidate(), {});
  const ComparedSignal& c = signal_of(*p, "velocity_1");
  EXPECT_TRUE(std::isnan(c.measured[200]));
  EXPECT_NEAR(c.measured[201], 3.0 / 1e-3 * 2.0 * std::numbers::pi / 16384.0, 1e-6);
}

TEST(PredictorRobot, ABusReadingThatNoSupplyGivesIsNotComparedAndSaid) {
  Dataset d = blank_robot(0.5, true);
  d.runs[0].signals["bus_voltage"][200] = 90.0;  // V, of a supply of 22
  const auto p = make_predictor(d, robot_candidate(), {});
  const ComparedSignal& c = signal_of(*p, "bus_voltage");
  EXPECT_TRUE(std::isnan(c.measured[200]));
  EXPECT_NEAR(c.measured[201], 22.1, 1e-12);
  EXPECT_NE(c.left_out.find("1 readings of bus_voltage that no supply gives"), std::string::npos);
}

}  // namespace
}  // namespace omnihil::test
