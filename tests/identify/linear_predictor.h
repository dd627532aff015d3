// A predictor that is linear in its parameters, so that what a fit or a screening has to find is a closed form:
//
//   y_i = sum over paths of value(path) * pattern_path_i
//
//   LinearPredictor p({{"constant_load.torque_Nm", s}, {"motor.viscous_friction_Nm_s_per_rad", b}});
//   p.add_measured(Split::kTraining, truth, 0.1, 1);      // what `truth` gives, with white noise of 0.1 rad/s
#pragma once
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim/law/effect_registry.h"
#include "sim/law/random.h"
#include "sim/model/axis_model.h"
#include "tests/identify/fake_predictor.h"

namespace omnihil {

class LinearPredictor final : public FakePredictor {
 public:
  explicit LinearPredictor(std::map<std::string, std::vector<double>> patterns)
      : patterns_(std::move(patterns)) {}

  const std::vector<double>& pattern(const std::string& path) const { return patterns_.at(path); }
  std::size_t samples() const { return patterns_.begin()->second.size(); }

  FakeRun& add_measured(Split split, const Candidate& truth, double sigma, std::uint64_t seed) {
    std::vector<double> y = values(truth);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += sigma * gaussian(seed, 11, i);
    return add(split, y, std::vector<double>(y.size(), 0.0), sigma);
  }

  Prediction predict(const Candidate& candidate, int) const override {
    return {.values = {values(candidate)}, .derivatives = {}};
  }
  Prediction predict_with_derivatives(const Candidate& candidate, std::span<const Unknown> unknowns,
                                      int run) const override {
    Prediction p = predict(candidate, run);
    Eigen::MatrixXd d = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(samples()),
                                              static_cast<Eigen::Index>(unknowns.size()));
    for (std::size_t u = 0; u < unknowns.size(); ++u) {
      const auto at = patterns_.find(unknowns[u].path);
      for (std::size_t i = 0; at != patterns_.end() && i < samples(); ++i)
        d(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(u)) = at->second[i];
    }
    p.derivatives.push_back(std::move(d));
    return p;
  }

 private:
  std::vector<double> values(const Candidate& candidate) const {
    std::vector<double> y(samples(), 0.0);
    for (const auto& [path, pattern] : patterns_) {
      const double value = value_at(candidate, path).value_or(0.0);
      for (std::size_t i = 0; i < y.size(); ++i) y[i] += value * pattern[i];
    }
    return y;
  }

  std::map<std::string, std::vector<double>> patterns_;
};

// An axis of which all but perhaps the viscous friction is known exactly. friction: as a model file has it, N m s/rad.
inline Candidate axis_with_friction(const std::string& friction) {
  AxisReading r = read_axis_model(R"x(
format = "omnihil-model/1"
rig = "axis"
[motor]
resistance_ohm = 0.5
torque_constant_Nm_per_A = 0.03
rotor_inertia_kg_m2 = 1e-5
pole_pairs = 7
slots = 12
viscous_friction_Nm_s_per_rad = )x" + friction +
                                      "\n[supply]\nvoltage_V = 24\n",
                                  "model.toml", nullptr);
  for (const ModelProblem& p : r.problems) ADD_FAILURE() << p.text();
  return r.model ? candidate_of(r.model->file, r.model->effects) : Candidate{};
}
inline Candidate axis_with_unknown_friction() {
  return axis_with_friction("{ value = 1e-5, tolerance = 1 }");  // relative 1-sigma
}

inline constexpr const char* kFriction = "motor.viscous_friction_Nm_s_per_rad";
inline constexpr const char* kLoad = "constant_load.torque_Nm";

inline Candidate with_load(const Candidate& model, double torque_Nm, double friction) {
  Candidate out = with_effect(model, *find_effect("constant_load"));
  EXPECT_EQ(set_value(out, kLoad, torque_Nm), "");
  EXPECT_EQ(set_value(out, kFriction, friction), "");
  return out;
}

// n samples of sin(2 pi k i / n + phase), times `size`.
inline std::vector<double> sine_pattern(std::size_t n, double k, double phase, double size) {
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i)
    out.push_back(size * std::sin(2.0 * M_PI * k * static_cast<double>(i) / static_cast<double>(n) + phase));
  return out;
}

inline double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace omnihil
