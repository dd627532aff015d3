// Noise of the measured motion is noise of a regressor: without care it makes the inertia too small.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "identify/estimate/fit.h"
#include "sim/law/random.h"
#include "sim/model/axis_model.h"

namespace omnihil {
namespace {

constexpr double kInertia_kg_m2 = 2e-5, kFriction_Nm_s_per_rad = 3e-5, kPeriod_s = 1e-3;
constexpr std::size_t kSamples = 20000;

// Torque in, motion measured: tau = J a + b w for a motion of five lines up to 12 Hz.
class TorqueDriven {
 public:
  TorqueDriven(const std::string& sensor, double sigma) {
    dataset_.rig = &rig_axis();
    dataset_.channels = {{.signal = "motor_torque", .column = "tau", .unit = "N m", .sigma = 1e-4},
                         {.signal = sensor, .column = "y", .unit = "rad/s", .sigma = sigma}};
    Run run;
    run.file = "torque.csv";
    for (std::size_t k = 0; k < kSamples; ++k) {
      const double t = kPeriod_s * static_cast<double>(k);
      double x = 0.0, w = 0.0, a = 0.0;
      for (const double hz : {0.3, 1.1, 3.0, 7.0, 12.0}) {
        const double omega = 2.0 * std::numbers::pi * hz;
        const double size = 30.0 / (1.0 + hz);
        x -= size / omega * std::cos(omega * t);
        w += size * std::sin(omega * t);
        a += size * omega * std::cos(omega * t);
      }
      run.time_s.push_back(t);
      run.signals["motor_torque"].push_back(kInertia_kg_m2 * a + kFriction_Nm_s_per_rad * w +
                                            1e-4 * gaussian(1, 1, k));
      run.signals[sensor].push_back((sensor == "velocity" ? w : x) + sigma * gaussian(1, 2, k));
      accelerations_.push_back(a);
    }
    dataset_.runs = {run};
  }

  double inertia_kg_m2() const {
    const AxisReading r = read_axis_model(
        "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\ntorque_constant_Nm_per_A = 0.03\n"
        "rotor_inertia_kg_m2 = { value = 1e-5, tolerance = 1 }\n"
        "viscous_friction_Nm_s_per_rad = { value = 1e-5, tolerance = 1 }\n",
        "m", nullptr);
    EXPECT_TRUE(r.model);
    const Candidate nominal = candidate_of(r.model->file, r.model->effects);
    const auto predictor = make_predictor(dataset_, nominal, {});
    const FitResult result = fit(*predictor, nominal, unknowns_of(nominal), {});
    return value_at(result.model, "motor.rotor_inertia_kg_m2").value_or(NAN);
  }

  double acceleration_square() const {
    double sum = 0.0;
    for (const double a : accelerations_) sum += a * a / static_cast<double>(kSamples);
    return sum;
  }

 private:
  Dataset dataset_;
  std::vector<double> accelerations_;
};

TEST(ErrorsInVariables, ANoisySpeedDoesNotMakeTheInertiaSmall) {
  const double sigma = 2.0;
  const TorqueDriven bench("velocity", sigma);
  // Noise of the acceleration in the band of 100 Hz, white speed noise of density 2 sigma^2 T: the integral of
  // (2 pi f)^2 2 sigma^2 T to f_c. Fuller 1987, sec. 1.1.1: what least squares would leave of the inertia.
  const double noise =
      2.0 * sigma * sigma * kPeriod_s * std::pow(2.0 * std::numbers::pi, 2) * std::pow(100.0, 3) / 3.0;
  const double reliability = bench.acceleration_square() / (bench.acceleration_square() + noise);
  ASSERT_LT(reliability, 0.5);
  EXPECT_NEAR(bench.inertia_kg_m2() / kInertia_kg_m2, 1.0, 0.02);
}

TEST(ErrorsInVariables, NorDoesTheNoiseOfAPosition) {
  EXPECT_NEAR(TorqueDriven("position", 2e-3).inertia_kg_m2() / kInertia_kg_m2, 1.0, 0.02);
}

}  // namespace
}  // namespace omnihil
