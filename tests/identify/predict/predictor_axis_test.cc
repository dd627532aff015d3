// What a model of an axis says the sensors would have shown: derivatives, clocks, gaps, slaved angle, both
// methods.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/predict/predictor.h"
#include "sim/bench/axis_sim.h"
#include "sim/drive/sensor_chain.h"
#include "sim/law/effect_registry.h"
#include "sim/law/random.h"
#include "sim/model/axis_model.h"
#include "tests/identify/rms.h"

namespace omnihil {
namespace {

omnihil::Run run_of(const std::string& file, bool steady = false) {
  omnihil::Run run;
  run.file = file;
  run.steady = steady;
  return run;
}

Candidate model(const std::string& more = "") {
  const std::string text = R"x(
format = "omnihil-model/1"
rig = "axis"
[motor]
resistance_ohm = { value = 0.5, tolerance = 0.1 }
inductance_H = { value = 0.0003, tolerance = 0.2 }
torque_constant_Nm_per_A = { value = 0.03, tolerance = 0.05 }
rotor_inertia_kg_m2 = { value = 1e-5, tolerance = 0.1 }
viscous_friction_Nm_s_per_rad = { value = 5e-6, tolerance = 1 }
pole_pairs = 8
slots = 12
[load]
inertia_kg_m2 = 5e-5
[supply]
voltage_V = 24
[effects.coulomb_friction]
torque_Nm = { value = 0.003, tolerance = 0.5 }
)x" + more;
  AxisReading r = read_axis_model(text, "model.toml", nullptr);
  for (const ModelProblem& p : r.problems) ADD_FAILURE() << p.text();
  return r.model ? candidate_of(r.model->file, r.model->effects) : Candidate{};
}

std::vector<double> steps(std::size_t n, double size) {
  std::vector<double> u;
  for (std::size_t k = 0; k < n; ++k) u.push_back(size * (double((k / 150) % 5) - 2.0) / 2.0);
  return u;
}

// A bench run of `truth` by duty: counts, current, bus.
Dataset bench(const Candidate& truth, std::size_t n, double size = 0.3) {
  constexpr double dt = 1e-3;
  Dataset d;
  d.rig = &rig_axis();
  d.channels = {{.signal = "duty", .column = "", .unit = "1"},
                {.signal = "encoder", .column = "", .unit = "counts", .counts_per_rev = 4096},
                {.signal = "motor_current", .column = "", .unit = "A", .sigma = 0.03}};
  omnihil::Run run = run_of("steps.csv");
  AxisInput in;
  for (std::size_t k = 0; k < n; ++k) in.time_s.push_back(double(k) * dt);
  in.command = steps(n, size);
  in.encoder_counts_per_turn = 4096;
  const auto out = run_axis<double>(drive_of(truth), EffectSet<double>(truth.effects), in, {.step_s = 25e-6});
  run.time_s = in.time_s;
  run.signals["duty"] = in.command;
  for (const auto& s : out) {
    run.signals["encoder"].push_back(encoder_reading(s.encoder_counts));
    run.signals["motor_current"].push_back(s.motor_current_A);
  }
  d.runs = {run};
  return d;
}

TEST(AxisPredictor, TheTrueModelLeavesTheRoundingOfCountsOnly) {
  const Candidate truth = model();
  const auto p = make_predictor(bench(truth, 1500), truth, {});
  EXPECT_FALSE(p->is_costly());
  ASSERT_EQ(p->method(), Method::kForward);
  const ComparedSignal& speed = p->compared(0)[0];
  EXPECT_EQ(speed.name, "velocity");
  const Prediction y = p->predict(truth, 0);
  // one count is 2 pi / 4096 rad; rounding: sigma of a difference = count / sqrt(6) / dt
  const double expected = 2.0 * std::numbers::pi / 4096 / std::sqrt(6.0) / 1e-3;
  EXPECT_NEAR(speed.noise_sigma, expected, 1e-9);
  EXPECT_NEAR(rms(speed.measured, y.values[0]), expected, 0.15 * expected);
  EXPECT_LT(rms(p->compared(0)[1].measured, y.values[1]), 0.1 * 0.03);
}

// Ten milliseconds of fine counts say that it stands still; one noisy reading of a speed sensor says 2 rad/s.
TEST(AxisPredictor, StartsAtTheSpeedOfTheCountsWhereThoseTellItBetter) {
  const Candidate truth = model();
  Dataset d = bench(truth, 1500);
  d.channels.push_back({.signal = "velocity", .column = "", .unit = "rad/s", .sigma = 1.0});
  std::vector<double>& speed = d.runs[0].signals["velocity"];
  const std::vector<double>& counts = d.runs[0].signals["encoder"];
  for (std::size_t k = 0; k < counts.size(); ++k) speed.push_back(k % 2 == 0 ? 2.0 : -2.0);
  for (std::size_t k = 0; k < 20; ++k) d.runs[0].signals["duty"][k] = 0.1;
  for (std::size_t k = 0; k < 25; ++k) d.runs[0].signals["encoder"][k] = static_cast<double>(k / 20);
  const auto p = make_predictor(d, truth, {});
  const Prediction y = p->predict(truth, 0);
  EXPECT_EQ(p->compared(0)[0].name, "velocity");
  EXPECT_NEAR(y.values[0][0], 0.0, 0.1);
}

TEST(AxisPredictor, WhiteningLeavesTheRoundingOfPositions) {
  const Candidate truth = model();
  const auto p = make_predictor(bench(truth, 4000), truth, {});
  const ComparedSignal& speed = p->compared(0)[0];
  const Prediction y = p->predict(truth, 0);
  std::vector<double> r(speed.measured);
  for (std::size_t k = 0; k < r.size(); ++k) r[k] -= y.values[0][k];
  const std::vector<double> w = whitened(speed, r);
  double square = 0.0, product = 0.0, n = 0.0;
  for (std::size_t k = 1000; k < w.size(); ++k) square += w[k] * w[k], product += w[k] * w[k - 1], n += 1.0;
  EXPECT_NEAR(std::sqrt(square / n), speed.whitened_sigma, 0.25 * speed.whitened_sigma);
  EXPECT_NEAR(speed.whitened_sigma, 2.0 * std::numbers::pi / 4096 / std::sqrt(12.0), 1e-6);
}

// A mean of differences over four samples is the displacement over four samples; before the first nothing moved.
TEST(AxisPredictor, TheMeanOfDifferencesIsTheDisplacementOverTheTimeOfAveraging) {
  ComparedSignal s;
  for (int k = 0; k < 12; ++k) s.time_s.push_back(0.01 * k);
  s.noise_sigma = 3.0;
  std::vector<double> x, v;
  for (int k = 0; k < 12; ++k) {
    x.push_back(0.1 * k * k);
    v.push_back(k > 0 ? (x[x.size() - 1] - x[x.size() - 2]) / 0.01 : kMissing);
  }
  EXPECT_EQ(averaged(s, std::vector<double>(v.begin() + 1, v.end())),
            std::vector<double>(v.begin() + 1, v.end()));
  s.averaging_s = 0.04;
  const std::vector<double> mean = averaged(s, v);
  EXPECT_TRUE(std::isnan(mean[0]));
  EXPECT_NEAR(mean[2], (x[2] - x[0]) / 0.04, 1e-9);
  for (std::size_t k = 4; k < 12; ++k) EXPECT_NEAR(mean[k], (x[k] - x[k - 4]) / 0.04, 1e-9);
  EXPECT_NEAR(averaged_sigma(s), 3.0 / 4.0, 1e-12);
}

// A potentiometer read with 10 bits steps by 0.06 rad: differenced at 1 kHz that is 25 rad/s of noise.
TEST(AxisPredictor, ACoarsePositionIsComparedOverATimeInWhichItsSensorResolvesTheMotion) {
  const Candidate truth = model();
  Dataset d = bench(truth, 3000, 0.03);
  constexpr double kStep_rad = 0.06;
  std::vector<double> position;
  for (const double counts : d.runs[0].signals["encoder"])
    position.push_back(kStep_rad * std::floor(2.0 * std::numbers::pi * counts / 4096 / kStep_rad));
  d.runs[0].signals.erase("encoder");
  d.runs[0].signals["position"] = position;
  d.channels[1] = {.signal = "position", .column = "", .unit = "rad"};
  const auto p = make_predictor(d, truth, {});
  const ComparedSignal& speed = p->compared(0)[0];
  const double rounding = kStep_rad / std::sqrt(6.0);  // of a displacement: both ends
  ASSERT_GT(speed.averaging_s, 1e-3);
  EXPECT_NEAR(averaged_sigma(speed) * speed.averaging_s, rounding, 0.2 * rounding);
  const double moved =
      rms(averaged(speed, speed.measured), std::vector<double>(3000, 0.0)) * speed.averaging_s;
  EXPECT_GT(moved, kResolved_sigmas * 0.8 * rounding);
  const Prediction y = p->predict(truth, 0);
  EXPECT_LT(rms(averaged(speed, speed.measured), averaged(speed, y.values[0])), 1.6 * averaged_sigma(speed));
}

TEST(AxisPredictor, DerivativesAreThoseOfTheValues) {
  Candidate c = model(
      "[effects.cogging]\namplitude_Nm = { value = 0.002, tolerance = 1 }\n"
      "[effects.dead_time]\nvoltage_V = { value = 0.2, tolerance = 1 }\n"
      "[effects.sampling_delay]\ndelay_s = { value = 0.0021, tolerance = 1 }\n[effects.winding_heating]\n"
      "temperature_coefficient_per_K = { value = 0.004, tolerance = 1 }\n"
      "[effects.actuator_delay]\ndelay_s = { value = 0.00333, tolerance = 1 }\n");
  const auto p = make_predictor(bench(model(), 600), c, {.step_s = 100e-6, .slave_angle = true});
  const std::vector<Unknown> unknowns = unknowns_of(c);
  ASSERT_GT(unknowns.size(), 8u);  // more than one stride
  const Prediction d = p->predict_with_derivatives(c, unknowns, 0);
  const Prediction y = p->predict(c, 0);
  for (std::size_t s = 0; s < y.values.size(); ++s) EXPECT_LT(rms(d.values[s], y.values[s]), 1e-9);
  std::vector<double> x;
  for (const Unknown& u : unknowns) x.push_back(u.start);
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const double h = 1e-5 * unknowns[u].scale;
    auto up = x, down = x;
    up[u] += h, down[u] -= h;
    const Prediction a = p->predict(with_values(c, unknowns, up), 0),
                     b = p->predict(with_values(c, unknowns, down), 0);
    for (std::size_t s = 0; s < y.values.size(); ++s) {
      double worst = 0.0, size = 0.0;
      std::vector<double> off;
      for (std::size_t k = 1; k < y.values[s].size(); ++k) {
        const double slope = (a.values[s][k] - b.values[s][k]) / (2.0 * h);
        off.push_back(std::abs(slope - d.derivatives[s](Eigen::Index(k), Eigen::Index(u))));
        size = std::max(size, std::abs(slope));
      }
      // friction that catches or releases within the difference's step has no slope there: a few samples
      std::sort(off.begin(), off.end());
      worst = off[off.size() * 95 / 100];
      EXPECT_LE(worst, 2e-3 * size + 1e-9) << unknowns[u].path << " " << p->compared(0)[s].name;
    }
  }
}

// Two masses that turn as one have one derivative; behind a shaft that gives each has its own.
TEST(AxisPredictor, RotorAndLoadHaveOneDerivativeUnlessTheShaftGives) {
  const auto share_of_rotors = [](const std::string& more) {
    const Candidate c = model(more);
    const auto p = make_predictor(bench(model(), 600), c, {.step_s = 100e-6});
    std::vector<Unknown> unknowns = unknowns_of(c);
    const auto at = [&](std::string_view path) {
      return std::ranges::find(unknowns, path, &Unknown::path) - unknowns.begin();
    };
    unknowns.push_back(unknowns[static_cast<std::size_t>(at("motor.rotor_inertia_kg_m2"))]);
    unknowns.back().path = "load.inertia_kg_m2";  // the model file states it without a tolerance
    const Eigen::MatrixXd d = p->predict_with_derivatives(c, unknowns, 0).derivatives[0];
    const auto rotor = d.col(at("motor.rotor_inertia_kg_m2")), load = d.col(at("load.inertia_kg_m2"));
    return std::pair(load.dot(rotor) / rotor.squaredNorm(), (load - rotor).norm() / load.norm());
  };
  const auto [rigid, rigid_apart] = share_of_rotors("");
  EXPECT_NEAR(rigid, 1.0, 1e-12);
  EXPECT_LT(rigid_apart, 1e-12);
  const auto [soft, soft_apart] =
      share_of_rotors("[effects.shaft_compliance]\ncompliance_rad_per_Nm = { value = 0.5, tolerance = 1 }\n");
  EXPECT_GT(soft_apart, 0.01);
}

// Otherwise an effect that asks for finer sub-steps and does nothing else lowers the error, and is named.
TEST(AxisPredictor, FinerStepsMoveNoSignalByMoreThanItsNoiseHidesOnceItIsWhitened) {
  const Candidate plain = model();
  const auto p = make_predictor(bench(plain, 4000, 0.9), plain, {.step_s = 100e-6, .slave_angle = true});
  const Candidate hardly = model("[effects.lugre_friction]\ncoulomb_torque_Nm = 1e-9\n");
  const Prediction a = p->predict(plain, 0), b = p->predict(hardly, 0);
  for (std::size_t c = 0; c < a.values.size(); ++c) {
    const ComparedSignal& signal = p->compared(0)[c];
    std::vector<double> d(a.values[c].size());
    for (std::size_t k = 0; k < d.size(); ++k) d[k] = a.values[c][k] - b.values[c][k];
    const std::vector<double> w = whitened(signal, d);
    const std::vector<double> none(w.size(), 0.0);
    EXPECT_LT(rms(w, none), 0.05 * signal.whitened_sigma) << signal.name;
    EXPECT_GT(rms(w, none), 0.0) << signal.name;
  }
}

TEST(AxisPredictor, SlavedAngleKeepsThePhaseOfCoggingUnderAWrongSpeed) {
  const Candidate truth = model("[effects.cogging]\namplitude_Nm = 0.01\norder = 12\n");
  const Dataset d = bench(truth, 3000, 0.02);
  Candidate wrong = truth;
  ASSERT_EQ(set_value(wrong, "motor.torque_constant_Nm_per_A", 0.0303), "");
  const auto residual = [&](bool slave, const Candidate& c) {
    const auto p = make_predictor(d, truth, {.step_s = 100e-6, .slave_angle = slave});
    const Prediction y = p->predict(c, 0);
    return rms(p->compared(0)[0].measured, y.values[0]);
  };
  const double floor = residual(true, truth);
  EXPECT_LT(residual(true, wrong), 1.15 * floor);
  EXPECT_GT(residual(false, wrong), 1.3 * floor);
}

TEST(AxisPredictor, MissingSamplesAndEmptyFirstRowsChangeNoOtherSample) {
  const Candidate truth = model();
  Dataset d = bench(truth, 800);
  const auto whole = make_predictor(d, truth, {});
  for (const std::size_t k : {300u, 301u, 500u}) d.runs[0].signals["encoder"][k] = kMissing;
  d.runs[0].signals["motor_current"][0] = kMissing;
  const auto holes = make_predictor(d, truth, {});
  const Prediction a = whole->predict(truth, 0), b = holes->predict(truth, 0);
  EXPECT_FALSE(std::isfinite(holes->compared(0)[0].measured[300]));
  EXPECT_TRUE(std::isfinite(holes->compared(0)[0].measured[302]));
  EXPECT_NEAR(b.values[0][302], (a.values[0][300] + a.values[0][301] + a.values[0][302]) / 3.0, 1e-3);
  EXPECT_NEAR(a.values[0][700], b.values[0][700], 1e-6);
}

TEST(AxisPredictor, AGapStartsAnewFromTheMeasuredSpeed) {
  const Candidate truth = model();
  Dataset d = bench(truth, 1200);
  omnihil::Run& run = d.runs[0];
  const auto cut = [](std::vector<double>& v) { v.erase(v.begin() + 400, v.begin() + 700); };
  cut(run.time_s);
  for (auto& [name, values] : run.signals) cut(values);
  const auto p = make_predictor(d, truth, {});
  const Prediction y = p->predict(truth, 0);
  const ComparedSignal& speed = p->compared(0)[0];
  EXPECT_FALSE(std::isfinite(speed.measured[400]));
  EXPECT_NE(speed.left_out, "");
  for (std::size_t k = 430; k < 450; ++k) EXPECT_NEAR(speed.measured[k], y.values[0][k], 6.0) << k;
}

TEST(AxisPredictor, SimulatedIsTheTruthThroughTheSensors) {
  const Candidate truth = model(), other = model("[effects.cogging]\namplitude_Nm = 0.004\n");
  const auto p = make_predictor(bench(other, 2000), truth, {});
  const auto null = p->simulated(truth, 7), again = p->simulated(truth, 7), next = p->simulated(truth, 8);
  const Prediction y = null->predict(truth, 0);
  for (std::size_t s = 0; s < 2; ++s) {
    const ComparedSignal& c = null->compared(0)[s];
    EXPECT_NEAR(rms(c.measured, y.values[s]), c.noise_sigma, 0.2 * c.noise_sigma) << c.name;
    EXPECT_TRUE(
        std::equal(c.measured.begin() + 1, c.measured.end(), again->compared(0)[s].measured.begin() + 1));
    EXPECT_GT(rms(c.measured, next->compared(0)[s].measured), 0.0);
  }
}

TEST(AxisPredictor, ASteadyPointIsHeldAgainstFrictionOfItsApproach) {
  const std::string text =
      "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\n"
      "torque_constant_Nm_per_A = 0.03\nrotor_inertia_kg_m2 = 1e-5\n[effects.coulomb_friction]\n"
      "torque_Nm = 0.002\n[effects.cogging]\namplitude_Nm = 0.004\norder = 6\n";
  const AxisReading r = read_axis_model(text, "m", nullptr);
  ASSERT_TRUE(r.model);
  const Candidate c = candidate_of(r.model->file, r.model->effects);
  Dataset d;
  d.channels = {{.signal = "motor_torque", .column = "", .unit = "N m"},
                {.signal = "position", .column = "", .unit = "rad"}};
  omnihil::Run run = run_of("map.csv", true);
  std::vector<double> expected;
  for (int k = 0; k < 200; ++k) {
    const bool forward = k < 100;
    const double angle = 0.06 * (forward ? k : 199 - k);
    run.time_s.push_back(k);
    run.signals["position"].push_back(angle);
    run.signals["motor_torque"].push_back(0.0);
    // motor = friction in the direction of approach - cogging
    expected.push_back((forward ? 1.0 : -1.0) * 0.002 - 0.004 * std::sin(6.0 * angle));
  }
  d.runs = {run};
  const auto p = make_predictor(d, c, {});
  const Prediction y = p->predict(c, 0);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    if (k >= 99 && k < 102) continue;  // the turn
    EXPECT_NEAR(y.values[0][k], expected[k], 1e-5) << k;
  }
}

TEST(AxisPredictor, KnownNumbersOfARunHoldAndHaveNoDerivative) {
  const Candidate c = model();
  Dataset d = bench(c, 300);
  d.runs.push_back(d.runs[0]);
  d.runs[1].known = {{"motor.resistance_ohm", 0.7}};
  const auto p = make_predictor(d, c, {});
  const std::vector<Unknown> unknowns = unknowns_of(c);
  ASSERT_EQ(unknowns[0].path, "motor.resistance_ohm");
  const Prediction a = p->predict_with_derivatives(c, unknowns, 0),
                   b = p->predict_with_derivatives(c, unknowns, 1);
  EXPECT_NE(a.values[0][200], b.values[0][200]);
  EXPECT_GT(a.derivatives[0].col(0).norm(), 0.0);
  EXPECT_EQ(b.derivatives[0].col(0).norm(), 0.0);
}

TEST(AxisPredictor, NoiseOfTheBusSensorDoesNotComeOutAsCurrent) {
  const Candidate truth = model();
  Dataset d = bench(truth, 2000), noisy_bus = d;
  for (Dataset* set : {&d, &noisy_bus}) {
    set->channels.push_back({.signal = "bus_voltage", .column = "", .unit = "V", .sigma = 0.1});
    std::vector<double>& bus = set->runs[0].signals["bus_voltage"];
    for (std::size_t k = 0; k < 2000; ++k) {
      // a real step of 2 V in the middle stays
      const double level = k < 1000 ? 24.0 : 22.0;
      bus.push_back(set == &d ? level : noisy(level, 0.1, 3, "bus", k));
    }
  }
  const auto a = make_predictor(d, truth, {}), b = make_predictor(noisy_bus, truth, {});
  const Prediction quiet = a->predict(truth, 0), loud = b->predict(truth, 0);
  // unfiltered: 0.1 V * duty 0.15 / 0.5 ohm = 30 mA
  EXPECT_LT(rms(quiet.values[1], loud.values[1]), 0.4 * 0.1 * 0.15 / 0.5);
  EXPECT_LT(std::abs(quiet.values[0][1020] - loud.values[0][1020]), 0.5);
}

TEST(AxisPredictor, ASaggingSupplyShowsInTheBusVoltage) {
  const Candidate truth = model("[effects.battery_sag]\nresistance_ohm = 0.2\n"), plain = model();
  Dataset d = bench(truth, 1500);
  AxisInput in;
  in.time_s = d.runs[0].time_s;
  in.command = d.runs[0].signals["duty"];
  d.channels.push_back({.signal = "bus_voltage", .column = "", .unit = "V", .sigma = 0.02});
  for (const auto& s : run_axis<double>(drive_of(truth), EffectSet<double>(truth.effects), in))
    d.runs[0].signals["bus_voltage"].push_back(s.bus_voltage_V);
  const auto p = make_predictor(d, plain, {});
  const auto error = [&](const Candidate& c) {
    return rms(p->compared(0)[2].measured, p->predict(c, 0).values[2]);
  };
  EXPECT_EQ(p->compared(0)[2].name, "bus_voltage");
  EXPECT_LT(error(truth), 0.25 * error(plain));
}

TEST(AxisPredictor, SaysWhichEffectsCannotAct) {
  const auto p = make_predictor(bench(model(), 50), model(), {});
  EXPECT_EQ(p->applies(*find_effect("cogging")), "");
  EXPECT_NE(p->applies(*find_effect("wheel_slip")), "");
  EXPECT_NE(p->applies(*find_effect("target_speed_limit")), "");
  EXPECT_NE(p->applies(*find_effect("winding_inductance")), "");
}

// Asked for the input that each settled speed takes, a bridge that loses more than it is given lets no current pass: the motor
// then lacks nothing at any speed, however absurd the points are.
TEST(AxisPredictor, ALossBeforeTheWindingIsNotAskedOfSettledPoints) {
  const Candidate base = model("[effects.dead_time]\nvoltage_V = 10\n");
  Dataset d;
  d.rig = &rig_axis();
  d.channels = {{.signal = "duty", .column = "", .unit = "1"},
                {.signal = "velocity", .column = "", .unit = "rad/s"}};
  omnihil::Run run = run_of("curve.csv", true);
  for (int k = 0; k < 40; ++k) {
    run.time_s.push_back(k);
    run.signals["duty"].push_back(0.01 * k);
    run.signals["velocity"].push_back(50.0 + 7.0 * (k % 3));
  }
  d.runs = {run};
  const auto settled = make_predictor(d, base, {});
  const auto apart = [&](const Candidate& c) {
    const Prediction p = settled->predict(c, 0);
    double sum = 0.0;
    for (std::size_t k = 0; k < 40; ++k) sum += std::abs(p.values[0][k] - 0.01 * double(k)) / 40.0;
    return sum;
  };
  EXPECT_GT(apart(model()), 0.1);  // u - k omega of 24 V
  EXPECT_LT(apart(base), 0.01) << "else there is another cause to refuse it";
  for (const char* id : {"dead_time", "coast_mode", "duty_limit", "pwm_dead_band", "battery_sag"}) {
    EXPECT_NE(settled->applies(*find_effect(id)).find("settled points"), std::string::npos) << id;
  }
  EXPECT_EQ(settled->applies(*find_effect("stribeck_friction")), "");
  d.runs.front().steady = false;
  EXPECT_EQ(make_predictor(d, model(), {})->applies(*find_effect("dead_time")), "");
}

// Full duty from the first sample on: within five samples the speed has gained a hundred times its noise.
TEST(AxisPredictor, ARecordThatStartsInAStepStartsAtRest) {
  constexpr double dt = 1e-3, sigma = 0.1;
  const Candidate truth = model();
  Dataset d;
  d.rig = &rig_axis();
  d.channels = {{.signal = "duty", .column = "", .unit = "1"},
                {.signal = "velocity", .column = "", .unit = "rad/s", .sigma = sigma}};
  omnihil::Run run = run_of("step.csv");
  AxisInput in;
  for (std::size_t k = 0; k < 400; ++k) in.time_s.push_back(double(k) * dt), in.command.push_back(0.3);
  run.time_s = in.time_s;
  run.signals["duty"] = in.command;
  for (const auto& s :
       run_axis<double>(drive_of(truth), EffectSet<double>(truth.effects), in, {.step_s = 25e-6}))
    run.signals["velocity"].push_back(s.velocity_rad_s);
  ASSERT_GT(run.signals["velocity"][4], 100 * sigma);
  d.runs = {run};
  const auto predictor = make_predictor(d, truth, {});
  const Prediction p = predictor->predict(truth, 0);
  for (std::size_t k = 0; k < 400; ++k)
    EXPECT_NEAR(p.values[0][k], run.signals["velocity"][k], sigma) << "sample " << k;
}

}  // namespace
}  // namespace omnihil
