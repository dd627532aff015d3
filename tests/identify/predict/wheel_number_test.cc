// Robots of two, three and six wheels in the predictor: the model that made the data explains them, derivatives are exact, an
// effect is found by its size.
#include <algorithm>

#include "identify/estimate/fit.h"
#include "sim/law/effect_registry.h"
#include "tests/identify/simulated_robot.h"

namespace omnihil::test {
namespace {

struct Wheels {
  std::string angles;
  int count;
};
const Wheels kWheelNumbers[] = {{"[90, 270]", 2}, {"[150, 270, 30]", 3}, {"[30, 90, 150, 210, 270, 330]", 6}};

Candidate candidate_with(const Wheels& w) {
  std::string text = kRobotModel;
  const std::string four = "[55, 135, 225, 305]";
  text.replace(text.find(four), four.size(), w.angles);
  if (w.count == 2)  // without rollers: held sideways by their own grip
    text +=
        "[tyre.lateral]\nextremum_slip = 0.1\nextremum_value = 0.75\nasymptote_slip = 0.4\nasymptote_value = "
        "0.6\n";
  const ModelReading reading = read_model(text, "model.toml", nullptr);
  for (const ModelProblem& p : reading.problems) ADD_FAILURE() << p.text();
  return candidate_of(*reading.model);
}

// That of four wheels with as many channels as there are wheels here.
Dataset blank_with(const Wheels& w, double duration_s) {
  Dataset d = blank_robot(duration_s, false);
  std::vector<Channel> channels;
  for (const Channel& c : d.channels) {
    if (!c.signal.ends_with("_4") || w.count >= 4) channels.push_back(c);
    if (w.count == 2 && c.signal.ends_with("_3")) channels.pop_back();
    for (int i = 5; c.signal.ends_with("_4") && i <= w.count; ++i) {
      channels.push_back(c);
      channels.back().signal.back() = channels.back().column.back() = static_cast<char>('0' + i);
    }
  }
  d.channels = channels;
  for (Run& run : d.runs) {
    for (const char* signal : {"duty", "encoder", "motor_current"}) {
      for (int i = w.count + 1; i <= 4; ++i) run.signals.erase(std::string(signal) + "_" + std::to_string(i));
      for (int i = 5; i <= w.count; ++i) {
        std::vector<double> like = run.signals[std::string(signal) + "_" + std::to_string(i - 3)];
        for (double& v : like) v = -0.7 * v;
        run.signals[std::string(signal) + "_" + std::to_string(i)] = like;
      }
    }
  }
  return d;
}

TEST(WheelNumber, TheModelThatMadeTheDataLeavesTheNoise) {
  for (const Wheels& w : kWheelNumbers) {
    const Candidate truth = candidate_with(w);
    const auto simulated = make_predictor(blank_with(w, 4.0), truth, {})->simulated(truth, 7);
    const Prediction y = simulated->predict(truth, 0);
    ASSERT_TRUE(y.finite) << w.count;
    int speeds = 0;
    for (std::size_t s = 0; s < simulated->compared(0).size(); ++s) {
      const ComparedSignal& signal = simulated->compared(0)[s];
      speeds += signal.name.starts_with("velocity") ? 1 : 0;
      double square = 0.0, count = 0.0;
      for (std::size_t k = 0; k < signal.measured.size(); ++k) {
        const double r = signal.measured[k] - y.values[s][k];
        if (std::isfinite(r)) square += r * r, count += 1.0;
      }
      EXPECT_LT(std::sqrt(square / count), 1.2 * signal.noise_sigma) << signal.name << " of " << w.count;
    }
    EXPECT_EQ(speeds, w.count);
  }
}

// Against central differences, away from kinks: a wheel that stops at another instant is one.
TEST(WheelNumber, DerivativesAreExact) {
  for (const Wheels& w : kWheelNumbers) {
    const Candidate truth = candidate_with(w);
    const auto p = make_predictor(blank_with(w, 1.0), truth, {})->simulated(truth, 7);
    const std::vector<Unknown> unknowns = {{.path = "robot.mass_kg", .unit = "kg"}};
    const Prediction y = p->predict_with_derivatives(truth, unknowns, 0);
    const double mass_kg = 2.4, h = 1e-5 * mass_kg;
    Candidate more = truth, less = truth;
    ASSERT_EQ(set_value(more, "robot.mass_kg", mass_kg + h), "");
    ASSERT_EQ(set_value(less, "robot.mass_kg", mass_kg - h), "");
    const Prediction up = p->predict(more, 0), down = p->predict(less, 0);
    double error = 0.0, size = 0.0;
    for (std::size_t s = 0; s < y.values.size(); ++s) {
      const double noise = p->compared(0)[s].noise_sigma;
      for (std::size_t k = 1; k < y.values[s].size(); ++k) {
        const double expected = (up.values[s][k] - down.values[s][k]) / (2.0 * h) / noise;
        const double got = y.derivatives[s](static_cast<Eigen::Index>(k), 0) / noise;
        if (!std::isfinite(expected)) continue;
        error += (got - expected) * (got - expected);
        size += expected * expected;
      }
    }
    EXPECT_GT(size, 0.0) << w.count;
    EXPECT_LT(std::sqrt(error), 0.01 * std::sqrt(size)) << w.count;
  }
}

// As many unknowns as there are wheels, and the fit of them finds the one that differs.
TEST(WheelNumber, OneWheelThatIsNotLikeTheOthersIsFound) {
  for (const Wheels& w : kWheelNumbers) {
    for (const auto& [id, ratio] :
         {std::pair{"motor_mismatch", 0.93}, std::pair{"wheel_radius_mismatch", 0.985}}) {
      const Candidate nominal = candidate_with(w), with = with_effect(nominal, *find_effect(id));
      const std::string which = std::string(id) + ".ratio_" + std::to_string(w.count);
      Candidate truth = with;
      ASSERT_EQ(set_value(truth, which, ratio), "");
      EXPECT_NE(set_value(truth, std::string(id) + ".ratio_" + std::to_string(w.count + 1), ratio), "")
          << w.count;
      std::vector<Unknown> unknowns = unknowns_of(with);
      std::erase_if(unknowns, [&](const Unknown& u) { return !u.path.starts_with(id); });
      ASSERT_EQ(unknowns.size(), static_cast<std::size_t>(w.count));
      const auto measured = make_predictor(blank_with(w, 4.0), nominal, {})->simulated(truth, 7);
      const FitResult result = fit(*measured, with, unknowns, {});
      for (const ParameterEstimate& p : result.parameters)
        EXPECT_NEAR(p.value, p.path == which ? ratio : 1.0, 4.0 * p.sigma) << p.path << " of " << w.count;
      EXPECT_NEAR(*value_at(result.model, which), ratio, 0.2 * (1.0 - ratio)) << w.count;
    }
  }
}

}  // namespace
}  // namespace omnihil::test
