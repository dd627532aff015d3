// A strength's grid finds the valley that a descent from the wrong side does not.
#include "identify/select/strength_grid.h"

#include <gtest/gtest.h>

#include "tests/identify/linear_predictor.h"

namespace omnihil {
namespace {

constexpr std::size_t kSamples = 400;

struct Scene {
  Candidate nominal = axis_with_unknown_friction();
  LinearPredictor predictor{{{kFriction, sine_pattern(kSamples, 3.0, 0.0, 1e5)},
                             {kLoad, sine_pattern(kSamples, 3.0, 0.7, 1000.0)}}};
  std::unique_ptr<Splits> splits;
  RefitSetup setup;

  explicit Scene(double hidden_Nm) {
    for (const Split split : {Split::kTraining, Split::kValidation, Split::kExtrapolation})
      predictor.add_measured(split, with_load(nominal, hidden_Nm, 1e-5), 0.01,
                             1 + static_cast<std::uint64_t>(split));
    const ComparedChannels channels = compared_channels(predictor);
    splits = std::make_unique<Splits>(Splits{WhitenedResiduals(predictor, channels, Split::kTraining),
                                             WhitenedResiduals(predictor, channels, Split::kValidation),
                                             WhitenedResiduals(predictor, channels, Split::kExtrapolation)});
    setup.splits = splits.get();
  }
  Candidate with(double load_Nm) const { return with_load(nominal, load_Nm, 1e-5); }
  Eigen::VectorXd residual(const Candidate& model) const {
    const WhitenedResiduals& fit = (*splits)[kTraining];
    return fit.residual(fit.predicted_runs(model, 1));
  }
};

TEST(StrengthGrid, FindsThePointNextToTheTruthOfEitherSign) {
  const EffectParam& row = find_effect("constant_load")->info->params[0];
  const Scene scene(0.0);
  const double visible = visible_size(row, scene.nominal);
  for (const double hidden : {2.0 * visible, -0.5 * visible}) {
    const Scene with_load(hidden);
    const Candidate neutral = with_load.with(0.0);
    const auto lower =
        below_on_strength_grid(with_load.setup, neutral, "constant_load", with_load.residual(neutral));
    ASSERT_TRUE(lower);
    EXPECT_NEAR(value_at(*lower, kLoad).value() / hidden, 1.0, 1e-9);  // both lie on the grid
  }
}

TEST(StrengthGrid, HasNothingBelowTheOptimum) {
  const EffectParam& row = find_effect("constant_load")->info->params[0];
  const double hidden = 1.2 * visible_size(row, Scene(0.0).nominal);  // between two points
  const Scene scene(hidden);
  const Candidate there = scene.with(hidden);
  EXPECT_FALSE(below_on_strength_grid(scene.setup, there, "constant_load", scene.residual(there)));
}

TEST(StrengthGrid, KeepsTheModelsOtherValues) {
  const EffectParam& row = find_effect("constant_load")->info->params[0];
  const double hidden = visible_size(row, Scene(0.0).nominal);
  const Scene scene(hidden);
  const Candidate bent = with_load(scene.nominal, 0.0, 5e-5), believed = scene.with(0.0);
  const auto lower = below_on_strength_grid(scene.setup, believed, "constant_load", scene.residual(bent));
  ASSERT_TRUE(lower);
  EXPECT_DOUBLE_EQ(value_at(*lower, kFriction).value(), 1e-5);
}

TEST(StrengthGrid, OfAnEffectThatTheModelHasNotIsNone) {
  const Scene scene(0.1);
  const Candidate model = scene.with(0.0);
  EXPECT_FALSE(below_on_strength_grid(scene.setup, model, "cogging", scene.residual(model)));
}

}  // namespace
}  // namespace omnihil
