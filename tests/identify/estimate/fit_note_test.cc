// What was believed of a number survives its fits: in the file, and as the prior of the next fit.
#include "identify/estimate/fit_note.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/law/effect_registry.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

Candidate read(const std::string& text) {
  AxisReading r = read_axis_model(text, "model.toml", nullptr);
  EXPECT_TRUE(r.model) << all_text(r.problems) << text;
  return r.model ? candidate_of(r.model->file, r.model->effects) : Candidate{};
}

FitResult fitted(const Dataset& data, const Candidate& c) {
  return fit(*make_predictor(data, c, {}), c, unknowns_of(c), {});
}

// As a file that a verb wrote is read again.
Candidate written(const FitResult& r) {
  return read(candidate_text(with_fit_noted(r, {.data = "sha256:0123456789ab", .date = "2026-11-23"})));
}

const ParameterEstimate& estimate(const FitResult& r, std::string_view path) {
  return *std::find_if(r.parameters.begin(), r.parameters.end(),
                       [&](const auto& p) { return p.path == path; });
}

// A drive whose winding has 1.3 times the sheet's resistance, 3 of its tolerances, and cogging.
class FitNote : public testing::Test {
 protected:
  void SetUp() override {
    std::string truth = kWheelModel;
    const std::string sheet = "value = 0.464";
    truth.replace(truth.find(sheet), sheet.size(), "value = 0.6032");
    bench_ = simulated_bench({.with = {"cogging.amplitude_Nm=0.02"},
                              .excitations = {Excitation::kSteps, Excitation::kPrbs},
                              .duration_s = 2.0,
                              .model = truth});
    nominal_ = read(kWheelModel);
  }

  // Within a tenth of the uncertainty, angles up to whole turns; the priors exactly.
  void expect_same(const FitResult& one, const FitResult& other) {
    ASSERT_EQ(one.parameters.size(), other.parameters.size());
    for (const ParameterEstimate& a : one.parameters) {
      const ParameterEstimate& b = estimate(other, a.path);
      const bool angle = a.path.ends_with("phase_rad");
      const double apart = a.value - b.value;
      EXPECT_NEAR(angle ? std::remainder(apart, 2.0 * std::numbers::pi) : apart, 0.0, 0.1 * a.sigma)
          << a.path << " " << a.value;
      EXPECT_NEAR(a.sigma, b.sigma, 0.05 * a.sigma) << a.path;
      EXPECT_DOUBLE_EQ(a.prior_sigma, b.prior_sigma) << a.path;
      if (a.prior_sigma == 0.0) continue;  // flat: it has no mean
      EXPECT_DOUBLE_EQ(a.prior_mean, b.prior_mean) << a.path;
      EXPECT_EQ(a.prior_form, b.prior_form) << a.path;
    }
  }

  Bench bench_;
  Candidate nominal_;
};

TEST_F(FitNote, FittedTwiceIsFittedOnce) {
  const FitResult once = fitted(bench_.dataset, nominal_);
  const FitResult twice = fitted(bench_.dataset, written(once));
  expect_same(once, twice);
  const ParameterEstimate& r = estimate(twice, "motor.resistance_ohm");
  EXPECT_DOUBLE_EQ(r.prior_deviation_sigmas, (r.value - 0.464) / 0.0464);
  EXPECT_GT(r.prior_deviation_sigmas, 2.0);
}

TEST_F(FitNote, FitAddAndFitAgainIsOneFitOfTheLargerModel) {
  const EffectEntry& cogging = *find_effect("cogging");
  const FitResult once = fitted(bench_.dataset, with_effect(nominal_, cogging));
  const Candidate base = written(fitted(bench_.dataset, nominal_));
  const Candidate added = written(fitted(bench_.dataset, with_effect(base, cogging)));
  expect_same(once, fitted(bench_.dataset, added));
}

// A belief as firm as the data holds the resistance between the two. A prior that followed the fit would let
// it go half of what is left with every further fit.
TEST_F(FitNote, APriorThatHoldsGoesOnHolding) {
  std::string firm = kWheelModel;
  const std::string sheet = "value = 0.464, tolerance = 0.1";
  firm.replace(firm.find(sheet), sheet.size(), "value = 0.464, tolerance = 4e-3");
  Candidate c = read(firm);
  std::vector<double> resistance;
  for (int n = 0; n < 8; ++n) {
    const FitResult r = fitted(bench_.dataset, c);
    resistance.push_back(estimate(r, "motor.resistance_ohm").value);
    c = written(r);
  }
  EXPECT_GT(resistance.front(), 0.464 + 0.2 * (0.6032 - 0.464));
  EXPECT_LT(resistance.front(), 0.464 + 0.8 * (0.6032 - 0.464));
  // The weights of the signals are those of the residuals where a fit starts: they settle after a few.
  EXPECT_NEAR(resistance.back(), resistance.front(), 0.1 * (0.6032 - 0.464));
  EXPECT_NEAR(resistance[7], resistance[6], 1e-3 * (0.6032 - 0.464));
}

TEST_F(FitNote, NumbersThatDidNotMoveKeepTheirText) {
  std::vector<Unknown> some = unknowns_of(nominal_);
  std::erase_if(some, [](const Unknown& u) { return u.path != "motor.resistance_ohm"; });
  const FitResult r = fit(*make_predictor(bench_.dataset, nominal_, {}), nominal_, some, {});
  const std::string text = candidate_text(with_fit_noted(r, {.data = "sha256:0", .date = "2026-11-23"}));
  EXPECT_NE(text.find("inductance_H = { value = 0.000322, tolerance = 0.2 }\n"), std::string::npos) << text;
  EXPECT_NE(text.find("source = \"fitted\", data = \"sha256:0\", date = \"2026-11-23\", believed = { value = "
                      "0.464, tolerance = 0.1 } }\n"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace omnihil
