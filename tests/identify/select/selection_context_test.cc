// What every iteration of the selection uses, on a record whose fit, residual and null are closed forms.
#include "identify/select/selection_context.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/identify/torque_map.h"

namespace omnihil {
namespace {

constexpr double kSigma_Nm = 1e-4;  // of a torque map
const auto kNeverStop = [] { return false; };

TEST(SelectionContextTest, TheBaseFitIsTheRegression) {
  const TorqueMap map({});
  SelectionContext context(map.dataset, map.nominal, {});
  ASSERT_TRUE(context.fit_base(kNeverStop));
  // b = sum w (y + L) / sum w^2; the file's 1e-5 +- 1e-5 pulls by (s / 1e-5)^2 / sum w^2, 2e-5 of the difference
  double wy = 0.0;
  for (int i = 0; i < TorqueMap::kPoints; ++i)
    wy += TorqueMap::speed_rad_s(i) * map.without_brake_Nm(kTraining, i);
  const double expected = wy / TorqueMap::speeds_squared();
  EXPECT_NEAR(value_at(context.base().fit.model, kFriction).value(), expected, 1e-4 * expected);
}

TEST(SelectionContextTest, BegunElsewhereItEndsThereTooAndItsIntervalsMoveNothing) {
  const TorqueMap map({});
  SelectionContext context(map.dataset, map.nominal, {}), further(map.dataset, map.nominal, {});
  ASSERT_TRUE(context.fit_base(kNeverStop));
  Candidate start = map.nominal;
  ASSERT_EQ(set_value(start, kFriction, 2.0 * value_at(map.nominal, kFriction).value()), "");
  ASSERT_TRUE(further.fit_base(kNeverStop, start));
  const double fitted = value_at(context.base().fit.model, kFriction).value();
  EXPECT_NEAR(value_at(further.base().fit.model, kFriction).value(), fitted, 1e-4 * fitted);
  // the prior is the nominal model's, not that of where it began
  EXPECT_EQ(further.base().fit.parameters[0].prior_mean, context.base().fit.parameters[0].prior_mean);
  const bool converged = context.base().fit.converged;
  context.profile_base(kNeverStop);
  EXPECT_NEAR(value_at(context.base().fit.model, kFriction).value(), fitted, 1e-12 * fitted);
  EXPECT_EQ(context.base().fit.converged, converged);
  EXPECT_GT(context.base().fit.parameters[0].sigma, 0.0);
}

TEST(SelectionContextTest, ALoadThatTheModelLacksIsLeftInEveryResidual) {
  const double load_Nm = 0.004;
  const TorqueMap map({.load_Nm = load_Nm});
  SelectionContext context(map.dataset, map.nominal, {});
  ASSERT_TRUE(context.fit_base(kNeverStop));
  const double n = TorqueMap::kPoints;
  for (const Split split : {kTraining, kValidation}) {
    const Eigen::VectorXd& residual = context.base().residual[split];
    ASSERT_EQ(residual.size(), TorqueMap::kPoints);
    // a mean of n samples scatters by sigma / sqrt(n)
    EXPECT_NEAR(residual.mean(), -load_Nm, 5.0 * kSigma_Nm / std::sqrt(n)) << split_name(split);
  }
  EXPECT_EQ(context.base().residual[kExtrapolation].size(), 0);  // no such runs
}

TEST(SelectionContextTest, TheNullIsTheNoiseOfTheSensors) {
  const TorqueMap map({.load_Nm = 0.004});  // which a null of the base model does not have
  SelectionContext context(map.dataset, map.nominal, {.seed = 3});
  ASSERT_TRUE(context.fit_base(kNeverStop));
  context.simulate();
  const int replicates = context.null().replicates();
  EXPECT_EQ(replicates, 12);  // DECISIONS 22
  for (const Split split : {kTraining, kValidation}) {
    const double sigma_Nm = context.predictor().compared(split)[0].noise_sigma;
    // The mean of K n squares of normal numbers scatters by sqrt(2 / (K n)).
    const double scatter = std::sqrt(2.0 / (replicates * TorqueMap::kPoints));
    EXPECT_NEAR(context.null().floor(split)[0] / (sigma_Nm * sigma_Nm), 1.0, 5.0 * scatter);
  }
}

TEST(SelectionContextTest, EveryLawIsATaskOrSaysWhyNot) {
  const TorqueMap map({});
  SelectionContext context(map.dataset, map.nominal, {});
  ASSERT_TRUE(context.fit_base(kNeverStop));
  context.simulate();
  std::vector<std::string> not_applicable;
  const SelectionTask task = context.task(not_applicable);
  std::set<std::string> named;
  for (const EffectEntry* e : task.applicable) named.emplace(e->info->id);
  EXPECT_TRUE(named.contains("constant_load"));
  EXPECT_TRUE(named.contains("coulomb_friction"));
  EXPECT_FALSE(named.contains("dead_time"));  // of a bridge that these data do not have
  for (const std::string& why : not_applicable) {
    const std::size_t colon = why.find(": ");
    ASSERT_NE(colon, std::string::npos) << why;
    EXPECT_LT(colon + 2, why.size()) << why;
    EXPECT_TRUE(named.insert(why.substr(0, colon)).second) << why;
  }
  std::set<std::string> laws;
  for (const EffectEntry* e : all_effects()) {
    if (!is_formula(*e->info)) laws.emplace(e->info->id);
  }
  EXPECT_EQ(named, laws);
  EXPECT_EQ(task.acceptance_context.resolution.rate_Hz, 1.0 / TorqueMap::kPeriod_s);
}

TEST(SelectionContextTest, AStopIsHeardInTheBaseFit) {
  const TorqueMap map({});
  SelectionContext context(map.dataset, map.nominal, {});
  context.fit_base([] { return true; });
  EXPECT_EQ(value_at(context.base().fit.model, kFriction), value_at(map.nominal, kFriction));
}

}  // namespace
}  // namespace omnihil
