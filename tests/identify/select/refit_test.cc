// A refit of a linear model ends where the normal equations say, and never above its parent.
#include "identify/select/refit.h"

#include <gtest/gtest.h>

#include "tests/identify/linear_predictor.h"

namespace omnihil {
namespace {

constexpr std::size_t kSamples = 2000;
constexpr double kNoise = 0.01;

struct Scene {
  Candidate nominal = axis_with_unknown_friction();
  LinearPredictor predictor{{{kFriction, sine_pattern(kSamples, 3.0, 0.0, 1e5)},
                             {kLoad, sine_pattern(kSamples, 3.0, 0.7, 1000.0)}}};
  std::unique_ptr<Splits> splits, unweighted;
  RefitSetup setup;

  Scene(double hidden_Nm, double friction) {
    for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation})
      predictor.add_measured(split, with_load(nominal, hidden_Nm, friction), kNoise,
                             1 + static_cast<std::uint64_t>(split));
    const ComparedChannels channels = compared_channels(predictor);
    const auto all = [&](Weighing w) {
      return std::make_unique<Splits>(
          Splits{WhitenedResiduals(predictor, channels, Split::kTraining, w),
                 WhitenedResiduals(predictor, channels, Split::kValidation, w),
                 WhitenedResiduals(predictor, channels, Split::kExtrapolation, w)});
    };
    splits = all(Weighing::kWhitened);
    unweighted = all(Weighing::kUnweighted);
    setup.predictor = &predictor;
    setup.splits = splits.get();
    setup.unweighted = unweighted.get();
    setup.nominal = &nominal;
    setup.coarse = false;
    setup.profile = false;
  }
  Fitted base() const { return refit_as_it_is(setup, nominal, 1); }
  Screened started_at(double torque_Nm) const {
    Screened s;
    s.entry = find_effect("constant_load");
    s.name = "constant_load";
    s.start = neutral_use(*s.entry);
    s.start.values[0] = torque_Nm;
    s.share = 0.9;
    s.tried = true;
    return s;
  }
};

double value(const Fitted& f, const char* path) { return value_at(f.fit.model, path).value(); }

TEST(Refit, FindsStrengthAndBaseParameterTogether) {
  const Scene scene(0.02, 1.4e-5);
  const Fitted parent = scene.base();
  ASSERT_TRUE(parent.finite);
  const Fitted child = refit(scene.setup, parent, scene.started_at(0.001));
  // Standard errors of both, from the inverse of the 2 x 2 normal matrix: cosine of the patterns is cos 0.7.
  const double sine2 = std::pow(std::sin(0.7), 2), root = std::sqrt(kSamples / 2.0);
  EXPECT_NEAR(value(child, kLoad), 0.02, 4 * kNoise / (1000.0 * root * std::sqrt(sine2)));
  EXPECT_NEAR(value(child, kFriction), 1.4e-5, 4 * kNoise / (1e5 * root * std::sqrt(sine2)));
  // and what it leaves is the noise: its mean square within five standard deviations (sqrt(2 / n))
  const double left = child.residual[kValidation].squaredNorm() / kSamples;
  EXPECT_NEAR(left / (kNoise * kNoise), 1.0, 5 * std::sqrt(2.0 / kSamples));
}

TEST(Refit, NeverEndsAboveItsParent) {
  const Scene scene(0.0, 1.0e-5);  // nothing hidden
  const Fitted parent = scene.base();
  for (const double start : {-5.0, 0.5, 5.0}) {
    const Fitted child = refit(scene.setup, parent, scene.started_at(start));
    EXPECT_LE(child.residual[kTraining].squaredNorm(), parent.residual[kTraining].squaredNorm() * (1 + 1e-9))
        << start;
  }
}

TEST(Refit, KeepsThePriorsOfTheModelFileThroughAdditions) {
  const Scene scene(0.02, 1.4e-5);
  const Fitted parent = scene.base();
  const std::vector<Unknown> unknowns = unknowns_with_priors(parent.fit.model, scene.nominal);
  ASSERT_EQ(unknowns.size(), 1u);
  EXPECT_NE(unknowns[0].start, 1e-5);  // where the fit of the base model ended
  EXPECT_EQ(unknowns[0].prior_mean, 1e-5);
  EXPECT_EQ(unknowns[0].prior_sigma, 1e-5);
}

TEST(Refit, OfAConvergedModelChangesNothing) {
  const Scene scene(0.0, 1.3e-5);
  const Fitted once = scene.base();
  const Fitted again = refit_to_convergence(scene.setup, once);
  EXPECT_NEAR(value(again, kFriction) / value(once, kFriction), 1.0, 1e-6);
}

TEST(Refit, GivesUpWhenItIsTold) {
  Scene scene(0.02, 1.4e-5);
  const Fitted parent = scene.base();
  scene.setup.stop = [] { return true; };
  const Fitted child = refit(scene.setup, parent, scene.started_at(0.001));
  EXPECT_LE(child.residual[kTraining].squaredNorm(), parent.residual[kTraining].squaredNorm() * (1 + 1e-9));
}

}  // namespace
}  // namespace omnihil
