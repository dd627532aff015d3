// A robot of which the radio's commands are known and no duties: the model's controller closes the loop.
#include <algorithm>
#include <cmath>

#include "hil/dataset/dataset_reader.h"
#include "identify/checks/check_data.h"
#include "identify/estimate/fit.h"
#include "identify/predict/predictor.h"
#include "identify/predict/robot_motion.h"
#include "sim/law/effect_registry.h"
#include "sim/law/random.h"
#include "sim/model/rolling_model.h"
#include "tests/identify/simulated_radio.h"

namespace omnihil::test {
namespace {

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

// A motion that hears nothing of the sensors is made once and read by each draw of them. A law of the heading that does nothing
// has it made with the camera followed: the same numbers.
TEST(RadioDriven, AMotionThatTheCameraReadsIsTheOneThatFollowsIt) {
  const Candidate truth = radio_candidate();
  Candidate looks = truth;
  looks.effects.push_back(neutral_use(*find_effect("floor_tilt"), nullptr, kWheels));
  const auto p = make_predictor(blank_radio(3.0), truth, {});
  for (const std::uint64_t seed : {3u, 4u}) {
    const auto made = p->simulated(truth, seed), by_one_that_looks = p->simulated(looks, seed);
    const Prediction one = made->predict(truth, 0), other = by_one_that_looks->predict(looks, 0);
    ASSERT_EQ(one.values.size(), other.values.size());
    for (std::size_t s = 0; s < one.values.size(); ++s) {
      for (std::size_t k = 0; k < one.values[s].size(); ++k) {
        const double a = made->compared(0)[s].measured[k], b = by_one_that_looks->compared(0)[s].measured[k];
        const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
        ASSERT_TRUE(same(one.values[s][k], other.values[s][k])) << made->compared(0)[s].name << " " << k;
        ASSERT_TRUE(same(a, b)) << made->compared(0)[s].name << " " << k;
      }
    }
  }
}

// Speeds whose noise is as large as any motion (a coarse encoder, read often): a robot that stands is not begun at one reading
// of them, one that drives not at rest.
TEST(RadioDriven, TheStartIsNotOneNoisyReading) {
  const auto nominal = rolling_params(radio_candidate().file.parameters);
  const double angle[] = {55, 135, 225, 305};
  for (const double v_m_s : {0.0, 1.5}) {
    Dataset d = blank_radio(2.0);
    for (Channel& c : d.channels) c.sigma = 0.0;  // to be found in the readings
    for (std::size_t i = 0; i < 4; ++i) {
      std::vector<double>& w = d.runs[0].signals["wheel_speed_" + std::to_string(i + 1)];
      const double a = angle[i] * std::numbers::pi / 180.0;
      for (std::size_t k = 0; k < w.size(); ++k)
        w[k] = -std::sin(a) * v_m_s / 0.027 + 15.0 * gaussian(5, i, static_cast<std::uint64_t>(k));
    }
    const BodyVelocity<double> start = robot_record(d, d.runs[0], nominal).start_velocity;
    if (v_m_s == 0.0) {
      EXPECT_EQ(start.v_forward_m_s, 0.0);
      EXPECT_EQ(start.v_left_m_s, 0.0);
      EXPECT_EQ(start.omega_body_rad_s, 0.0);
    } else {  // means over 7 rows: 15 / sqrt(7) rad/s a wheel, 0.027 m, two pairs of them
      EXPECT_NEAR(start.v_forward_m_s, v_m_s, 3.0 * 15.0 / std::sqrt(7.0) * 0.027 / std::sqrt(2.0));
    }
  }
}

// A heading that is held while the robot turns on is no measurement: its rows are no frames, in the null neither, and the
// data's checks say so. One that is held while the robot stands is what it is.
TEST(RadioDriven, AHeadingThatWentSilentIsNotMeasured) {
  const Candidate truth = radio_candidate();
  const auto nominal = rolling_params(truth.file.parameters);
  Dataset d = blank_radio(8.0);
  for (omnihil::Run& run : d.runs) {  // stands for 3 s, then turns at 1.5 rad/s
    for (const char* axis : {"command_vx", "command_vy"}) run.signals[axis].assign(run.time_s.size(), 0.0);
    for (std::size_t k = 0; k < run.time_s.size(); ++k)
      run.signals["command_w"][k] = run.time_s[k] < 3.0 ? 0.0 : 1.5;
  }
  const auto simulated = make_predictor(d, truth, {})->simulated(truth, 3);
  for (std::size_t r = 0; r < d.runs.size(); ++r) d.runs[r] = simulated->run(static_cast<int>(r));
  std::vector<double>& theta = d.runs[0].signals["vision_theta"];
  for (std::size_t k = 60; k < 150; ++k) theta[k] = theta[60];  // 1 s to 2.5 s: stands
  EXPECT_TRUE(robot_record(d, d.runs[0], nominal).silent.empty());
  for (std::size_t k = 300; k < theta.size(); ++k) theta[k] = 0.0;  // 5 s on
  const RobotRecord record = robot_record(d, d.runs[0], nominal);
  ASSERT_EQ(record.silent.size(), 1u);
  EXPECT_EQ(record.silent[0].from, 300u);
  EXPECT_NEAR(record.silent[0].moved, 1.5 * (8.0 - 5.0), 0.3);
  for (const CameraFrame& f : record.frames) {
    EXPECT_TRUE(std::isfinite(f.pose[0]));
    EXPECT_EQ(std::isfinite(f.pose[2]), f.sample < 300) << f.sample;
  }
  const auto p = make_predictor(d, truth, {}), null = make_predictor(d, truth, {})->simulated(truth, 4);
  for (std::size_t s = 0; s < p->compared(0).size(); ++s) {
    for (std::size_t k = 0; k < theta.size(); ++k)
      ASSERT_EQ(std::isfinite(p->compared(0)[s].measured[k]), std::isfinite(null->compared(0)[s].measured[k]))
          << p->compared(0)[s].name << k;
  }
  const std::vector<DataFinding> findings = check_data(d, truth);
  const auto said =
      std::find_if(findings.begin(), findings.end(), [](const DataFinding& f) { return f.kind == "silent"; });
  ASSERT_NE(said, findings.end());
  EXPECT_NE(said->sentence.find("its sensor went silent"), std::string::npos) << said->sentence;
}

// A motion that is cut anywhere and gone on with is the whole one, derivatives too.
TEST(RadioDriven, AMotionInPiecesIsTheWholeOne) {
  const Candidate model = radio_candidate();
  const Dataset d = blank_radio(6.0);
  const std::vector<Unknown> unknowns = unknowns_of(model);
  const auto values = rolling_values<Jet>({model, unknowns});
  const auto nominal = rolling_params(model.file.parameters);
  const RobotMotionOptions options{.slave_angle = false, .follow_camera = false, .noise_seed = {}};
  const RobotMotion<Jet> whole = run_robot(values, robot_record(d, d.runs[0], nominal), options);
  RobotCarry<Jet> carry;
  std::size_t first = 0;
  for (const std::size_t last : {40u, 41u, 133u, 250u, 359u}) {
    omnihil::Run piece = d.runs[0];
    const auto cut = [&](std::vector<double>& v) {
      v = std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(first),
                              v.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    };
    cut(piece.time_s);
    for (auto& [name, signal] : piece.signals) cut(signal);
    const RobotMotion<Jet> part = run_robot(values, robot_record(d, piece, nominal), options, &carry);
    ASSERT_TRUE(part.finite);
    for (std::size_t k = first; k <= last; ++k) {
      for (std::size_t i = 0; i < kWheels; ++i) {
        const Jet &a = whole.samples[k].wheel_rad_s[i], &b = part.samples[k - first].wheel_rad_s[i];
        ASSERT_NEAR(a.a, b.a, 1e-9) << k;
        ASSERT_LT((a.v - b.v).norm(), 1e-9 * (1.0 + a.v.norm())) << k;
      }
    }
    first = last;
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

// As good a chance to end at the bound as beside it: one of three draws of the noise does.
TEST(RadioDriven, AFilterThatIsNotThereIsNone) {
  Candidate nominal = radio_candidate(), truth = nominal;
  Parameter* filter = nominal.file.parameters.find("controller.speed_filter_s");
  ASSERT_NE(filter, nullptr);
  filter->tolerance = 1.0;
  EXPECT_EQ(set_value(truth, "controller.speed_filter_s", 0.0), "");
  const auto p = make_predictor(blank_radio(10.0), nominal, {});
  int at_none = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto measured = p->simulated(truth, seed);
    const FitResult found = fit(*measured, nominal, unknowns_of(nominal), {});
    for (const ParameterEstimate& e : found.parameters) {
      if (e.path != "controller.speed_filter_s") continue;
      EXPECT_LT(e.value, 0.001) << seed;
      if (!e.at_bound) continue;
      EXPECT_EQ(e.sentence, "at its bound 0: these data know of none");
      ++at_none;
    }
  }
  EXPECT_GE(at_none, 1);
}

// Without a filter the loop sees the mean speed of its last period: what the encoder's counts say between two rows that are
// a period apart, and not what they said a row before.
TEST(RadioDriven, ARowTellsTheSpeedsOfTheLoopThatRunsAtIt) {
  Candidate robot = radio_candidate();
  EXPECT_EQ(set_value(robot, "controller.speed_filter_s", 0.0), "");
  Dataset d = blank_radio(1.0);
  d.channels.push_back({.signal = "encoder_1",
                        .column = "encoder_1",
                        .unit = "counts",
                        .clock_sigma_s = 0.0,
                        .counts_per_rev = 1e9});
  for (omnihil::Run& run : d.runs) {
    for (std::size_t k = 0; k < run.time_s.size(); ++k) {
      run.time_s[k] = 1e-3 * static_cast<double>(k);
      run.signals["command_vx"][k] = 1.0;
    }
    run.signals["encoder_1"].assign(run.time_s.size(), 0.0);
  }
  const auto p = make_predictor(d, robot, {});
  const Prediction y = p->predict(robot, 0);
  const auto predicted = [&](std::string_view name) {
    for (std::size_t s = 0; s < p->compared(0).size(); ++s)
      if (p->compared(0)[s].name == name) return y.values[s];
    return std::vector<double>{};
  };
  const std::vector<double> told = predicted("wheel_speed_1"), counted = predicted("velocity_1");
  ASSERT_EQ(told.size(), counted.size());
  const double gear = value_at(robot, "gear.ratio").value_or(0.0);
  for (std::size_t k = 2; k < told.size(); ++k)
    EXPECT_NEAR(told[k] * gear, counted[k], 1e-6 * std::abs(counted.back()) + 1e-9) << k;
}

TEST(RadioDriven, TheDelayBelongsToTheController) {
  const auto p = make_predictor(blank_radio(1.0), radio_candidate(), {});
  EXPECT_EQ(p->applies(*find_effect("actuator_delay")), "the base model has controller.latency_s");
  EXPECT_EQ(p->applies(*find_effect("payload")), "");
  EXPECT_EQ(p->applies(*find_effect("encoder_eccentricity")), "needs encoders");
}

}  // namespace
}  // namespace omnihil::test
