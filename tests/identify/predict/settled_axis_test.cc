// Settled points of an axis: what is known of a row is known of that row alone, and their noise does not depend on their order.
#include <gtest/gtest.h>

#include <cmath>

#include "identify/predict/predictor.h"
#include "sim/law/random.h"
#include "sim/model/axis_model.h"

namespace omnihil {
namespace {

constexpr double kK_Nm_per_A = 0.03;  // of motor()

Candidate motor() {
  const std::string text =
      "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\nresistance_ohm = 0.5\ninductance_H = 1e-4\n"
      "torque_constant_Nm_per_A = 0.03\nrotor_inertia_kg_m2 = 1e-5\n[supply]\nvoltage_V = 24\n";
  const AxisReading r = read_axis_model(text, "m", nullptr);
  return candidate_of(r.model->file, r.model->effects);
}

// A dynamometer's table as its operator writes it down: at each of 20 speeds the current from 1 to 41 A in nine steps.
// i = (c - L) / k + noise, with a brake L and a friction c that the model lacks.
Dataset dynamometer(double sigma_A, double stated_A, bool shuffled) {
  constexpr int kSpeeds = 20, kSteps = 9;
  constexpr double kFriction_Nm = 0.04;
  omnihil::Run run;
  run.file = "table.csv";
  run.steady = true;
  constexpr int kAnyOrder = 77;  // has no divisor in common with 180: each point once
  for (int k = 0; k < kSpeeds * kSteps; ++k) {
    const int point = shuffled ? k * kAnyOrder % (kSpeeds * kSteps) : k;
    const double brake_Nm = -kK_Nm_per_A * (1.0 + 5.0 * (point % kSteps));
    run.time_s.push_back(static_cast<double>(run.time_s.size()));
    run.signals["velocity"].push_back(10.0 + 20.0 * (point / kSteps));
    run.signals["load_torque"].push_back(brake_Nm);
    run.signals["motor_current"].push_back((kFriction_Nm - brake_Nm) / kK_Nm_per_A +
                                           sigma_A * gaussian(3, 0, static_cast<std::uint64_t>(point)));
  }
  Dataset d;
  d.rig = &rig_axis();
  d.channels = {{.signal = "motor_current", .column = "i", .unit = "A", .sigma = stated_A, .imposed = true},
                {.signal = "velocity", .column = "w", .unit = "rad/s", .imposed = true},
                {.signal = "load_torque", .column = "t", .unit = "N m"}};
  d.runs = {run};
  return d;
}

double noise_of(const Dataset& d) {
  const auto p = make_predictor(d, motor(), {});
  EXPECT_EQ(p->compared(0).size(), 1U);
  return p->compared(0).front().noise_sigma;
}

// The steps of the current from row to row are 25 times as large and more.
TEST(SettledAxis, StepsFromPointToPointAreNoNoise) {
  constexpr double kSigma_A = 0.2;
  for (const bool shuffled : {false, true}) {
    const double noise_A = noise_of(dynamometer(kSigma_A, 0.0, shuffled));
    // a sigma by the median of 180 deviations is known to 1.17 / sqrt(180) = 9 %: three of them
    EXPECT_NEAR(noise_A, kSigma_A, 0.27 * kSigma_A) << shuffled;
  }
}

TEST(SettledAxis, AStatedNoiseOfTheCurrentIsTaken) {
  const Dataset d = dynamometer(0.2, 0.3, false);
  EXPECT_DOUBLE_EQ(noise_of(d), 0.3);
  EXPECT_TRUE(make_predictor(d, motor(), {})->compared(0).front().noise_is_stated);
}

// A sweep of the duty in hundredths, ten times over: w = (d V - u_0) / k + noise.
Dataset sweeps(double sigma_rad_s) {
  constexpr int kSweeps = 10, kDuties = 60;
  omnihil::Run run;
  run.file = "sweeps.csv";
  run.steady = true;
  for (int row = 0; row < kSweeps * kDuties; ++row) {
    const double duty = 0.01 * (1 + row % kDuties), lost = 0.1;
    const double noise = sigma_rad_s * gaussian(5, 0, static_cast<std::uint64_t>(row));
    run.time_s.push_back(row);
    run.signals["duty"].push_back(duty);
    run.signals["velocity"].push_back(duty <= lost ? 0.0 : (duty - lost) * 24.0 / kK_Nm_per_A + noise);
  }
  Dataset d;
  d.rig = &rig_axis();
  d.channels = {{.signal = "duty", .column = "d", .unit = "1"},
                {.signal = "velocity", .column = "w", .unit = "rad/s"}};
  d.runs = {run};
  return d;
}

// 800 rad/s at full duty: 1 rad/s of noise is 0.00125 of it. Hundredths as a rounding would be 0.0029.
TEST(SettledAxis, ACommandHasTheNoiseOfTheSpeedAndNoneOfItsGrid) {
  const double noise = noise_of(sweeps(1.0));
  // by the median of 450 differences: 1.17 / sqrt(450) = 6 %; three of them
  EXPECT_NEAR(noise, 0.00125, 0.18 * 0.00125);
}

TEST(SettledAxis, AStatedNoiseOfTheDutyOrOfTheSpeedIsTaken) {
  Dataset d = sweeps(1.0);
  d.channels[0].sigma = 0.004;
  EXPECT_NEAR(noise_of(d), 0.004, 1e-9);
  d.channels[0].sigma = 0.0;
  d.channels[1].sigma = 3.0;
  EXPECT_NEAR(noise_of(d), 3.0 / 800.0, 0.01 * 3.0 / 800.0);
  EXPECT_TRUE(make_predictor(d, motor(), {})->compared(0).front().noise_is_stated);
}

// d V_k = k w_k: the supply of one point is not that of the points before and after it.
TEST(SettledAxis, ABusVoltageIsItsOwnRows) {
  Dataset d;
  d.rig = &rig_axis();
  d.channels = {{.signal = "duty", .column = "d", .unit = "1"},
                {.signal = "velocity", .column = "w", .unit = "rad/s"},
                {.signal = "bus_voltage", .column = "u", .unit = "V"}};
  omnihil::Run run;
  run.file = "table.csv";
  run.steady = true;
  std::vector<double> expected;
  for (int k = 0; k < 60; ++k) {
    const double bus_V = 20.0 + 0.5 * (k * 7 % 9), speed_rad_s = 50.0 + 5.0 * k;
    run.time_s.push_back(k);
    expected.push_back(kK_Nm_per_A * speed_rad_s / bus_V);
    run.signals["duty"].push_back(expected.back());
    run.signals["velocity"].push_back(speed_rad_s);
    run.signals["bus_voltage"].push_back(bus_V);
  }
  d.runs = {run};
  const Prediction y = make_predictor(d, motor(), {})->predict(motor(), 0);
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(y.values[0][k], expected[k], 1e-6) << k;
}

}  // namespace
}  // namespace omnihil
