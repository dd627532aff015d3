// What the screening says of an effect is the closed form of linear least squares, where the model is linear.
#include "identify/select/screening.h"

#include <gtest/gtest.h>

#include "tests/identify/linear_predictor.h"

namespace omnihil {
namespace {

constexpr std::size_t kSamples = 2000;

// Friction's pattern b and the load's s, a third of which b can imitate: s = s' + 0.5 b'.
struct Scene {
  Candidate model = axis_with_unknown_friction();
  std::vector<double> b = sine_pattern(kSamples, 3.0, 0.0, 1e9);
  std::vector<double> s;
  std::unique_ptr<LinearPredictor> predictor;
  ComparedChannels channels;
  std::unique_ptr<WhitenedResiduals> residuals;
  std::unique_ptr<LinearBase> base;
  ScreeningTask task;

  explicit Scene(double hidden_Nm) {
    s = sine_pattern(kSamples, 11.0, 0.3, 1000.0);
    const std::vector<double> shared = sine_pattern(kSamples, 3.0, 0.0, 500.0);
    for (std::size_t i = 0; i < kSamples; ++i) s[i] += shared[i];
    predictor = std::make_unique<LinearPredictor>(
        std::map<std::string, std::vector<double>>{{kFriction, b}, {kLoad, s}});
    predictor->add_measured(Split::kTraining, with_load(model, hidden_Nm, 1e-5), 0.01, 1);
    channels = compared_channels(*predictor);
    residuals = std::make_unique<WhitenedResiduals>(*predictor, channels, Split::kTraining);
    base = std::make_unique<LinearBase>(*residuals, model, unknowns_of(model), Eigen::VectorXd::Ones(1), 1);
    task = {.residuals = residuals.get(),
            .model = &model,
            .base = base.get(),
            .noise = {},
            .regimes = {},
            .scale = {},
            .jobs = 1,
            .progress = {}};
  }
  Screened load() const { return screen(task, {find_effect("constant_load")}).front(); }

  // What is left of s beside b; the prior of b is 1e-9 of its information in the data and does not count.
  std::vector<double> projected() const {
    std::vector<double> out = s;
    const double along = dot(s, b) / dot(b, b);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] -= along * b[i];
    return out;
  }
  std::vector<double> residual() const {
    const Eigen::VectorXd& r = base->residual();
    return {r.data(), r.data() + r.size()};
  }
};

TEST(Screening, GainIsThatOfLeastSquaresBesideTheBaseParameters) {
  const Scene scene(0.02);
  const std::vector<double> p = scene.projected(), r = scene.residual();
  const Screened load = scene.load();
  ASSERT_TRUE(load.tried);
  const double gain = dot(r, p) * dot(r, p) / dot(p, p);
  EXPECT_NEAR(load.gain / gain, 1.0, 1e-6);
  EXPECT_NEAR(load.share, gain / dot(r, r), 1e-6);
  EXPECT_NEAR(load.residual_fraction, dot(p, p) / dot(scene.s, scene.s), 1e-6);
  EXPECT_EQ(load.closest_parameter, kFriction);
}

TEST(Screening, StartsTheRefitAtTheHiddenStrengthOfEitherSign) {
  for (const double hidden : {0.02, -0.008}) {
    const Scene scene(hidden);
    const Screened load = scene.load();
    ASSERT_TRUE(load.tried);
    // sigma = noise / |p| = 0.01 / (1000 sqrt(n / 2)) = 3.2e-7
    EXPECT_NEAR(load.start.values[0], hidden, 4 * 3.2e-7);
    ASSERT_EQ(load.base_start.size(), 1u);
    EXPECT_NEAR(load.base_start[0], 1e-5, 1e-9);
  }
}

TEST(Screening, WhatTheNullGivesIsTakenOff) {
  Scene scene(0.02);
  const std::vector<double> p = scene.projected(), r = scene.residual();
  // A replicate that has the load's own pattern in it, a tenth of the residual's.
  Eigen::VectorXd noise(static_cast<Eigen::Index>(kSamples));
  for (std::size_t i = 0; i < kSamples; ++i) noise[static_cast<Eigen::Index>(i)] = 0.1 * r[i];
  scene.task.noise = {noise};
  const Screened load = scene.load();
  const double gain = dot(r, p) * dot(r, p) / dot(p, p);
  EXPECT_NEAR(load.null_gain / gain, 0.01, 1e-6);
  EXPECT_NEAR(load.share, 0.99 * gain / dot(r, r), 1e-6);
}

TEST(Screening, ARegimeIsScoredByItsOwnSamplesAlone) {
  Scene scene(0.02);
  const std::vector<double> p = scene.projected(), r = scene.residual();
  RegimeMask first{.name = "first quarter", .inside = Eigen::VectorXd::Zero(kSamples)};
  first.inside.head(kSamples / 4).setOnes();
  scene.task.regimes = {first};
  double rp = 0.0, pp = 0.0, rr = 0.0;
  for (std::size_t i = 0; i < kSamples / 4; ++i) rp += r[i] * p[i], pp += p[i] * p[i], rr += r[i] * r[i];
  const Screened load = scene.load();
  EXPECT_EQ(load.best_regime, "first quarter");
  EXPECT_NEAR(load.best_regime_share, rp * rp / pp / rr, 1e-6);
}

TEST(Screening, AnEffectThatTheBaseImitatesWhollyKeepsNothing) {
  Scene scene(0.02);
  LinearPredictor twin({{kFriction, scene.b}, {kLoad, scene.b}});
  twin.add_measured(Split::kTraining, with_load(scene.model, 0.02, 1e-5), 0.01, 1);
  const ComparedChannels channels = compared_channels(twin);
  const WhitenedResiduals residuals(twin, channels, Split::kTraining);
  const LinearBase base(residuals, scene.model, unknowns_of(scene.model), Eigen::VectorXd::Ones(1), 1);
  scene.task.residuals = &residuals;
  scene.task.base = &base;
  const Screened load = scene.load();
  EXPECT_LT(load.residual_fraction, kAliasedFraction);
  EXPECT_EQ(load.closest_parameter, kFriction);
  EXPECT_EQ(load.aliased_parameter(), "");  // its page does not name friction as what it is confused with
}

TEST(Screening, WhatAPriorPromisesIsNoFallOfTheResidual) {
  Scene scene(0.0);
  LinearPredictor twin({{kFriction, scene.b}, {kLoad, scene.b}});
  twin.add_measured(Split::kTraining, with_load(scene.model, 0.0, 1e-5), 0.01, 1);
  const ComparedChannels channels = compared_channels(twin);
  const WhitenedResiduals residuals(twin, channels, Split::kTraining);
  std::vector<Unknown> unknowns = unknowns_of(scene.model);
  ASSERT_EQ(unknowns.size(), 1u);
  // The data have the friction at 1e-5 to a part in 1e6, four standard deviations from its prior: a load could take over.
  unknowns[0].prior_form = PriorForm::kNormal;
  unknowns[0].prior_sigma = 1e-6;
  unknowns[0].prior_mean = 0.6e-5;
  const LinearBase base(residuals, scene.model, unknowns, Eigen::VectorXd::Ones(1), 1);
  ASSERT_TRUE(base.usable());
  scene.task.residuals = &residuals;
  scene.task.base = &base;
  const Screened load = scene.load();
  ASSERT_TRUE(load.tried);
  EXPECT_GT(load.share, 1.0);  // 4^2 over the noise's energy of 0.2
  // by chance 1 / 2000 of the noise
  EXPECT_LT(load.data_share(), 0.01);
}

TEST(Screening, WhatTheDataPromiseIsTheirs) {
  const Screened load = Scene(0.02).load();
  ASSERT_TRUE(load.tried);
  EXPECT_NEAR(load.data_share(), load.share, 1e-9);
}

TEST(Screening, StopsWhenItIsTold) {
  Scene scene(0.02);
  scene.task.progress = [](double) { return false; };
  const std::vector<Screened> all = screen(
      scene.task, {find_effect("constant_load"), find_effect("cogging"), find_effect("quadratic_drag")});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_TRUE(all[0].tried);
  EXPECT_FALSE(all[2].tried);
  EXPECT_EQ(all[2].name, "quadratic_drag");
}

// |speed| = i: the 98 % quantile is 1960; slow lies below a tenth of it, fast above six tenths.
TEST(RegimeMasks, FollowTheQuantilesOfSpeed) {
  Scene scene(0.02);
  std::vector<double> speed;
  for (std::size_t i = 0; i < kSamples; ++i) speed.push_back(static_cast<double>(i));
  scene.predictor->last().track("speed", "rad/s", speed);
  const std::vector<RegimeMask> masks = regime_masks(*scene.residuals, scene.model);
  ASSERT_EQ(masks.size(), 1u);  // 196 slow samples are too few to look at
  EXPECT_EQ(masks[0].name, "fast");
  EXPECT_EQ(masks[0].inside.sum(), 2000 - 1177);  // above 0.6 * 1960 = 1176
}

}  // namespace
}  // namespace omnihil
