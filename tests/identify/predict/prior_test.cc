#include "identify/predict/prior.h"

#include <gtest/gtest.h>

#include "identify/predict/candidate.h"
#include "tests/identify/simulated_bench.h"

namespace omnihil {
namespace {

TEST(Prior, IsNormalWhereTheValueIsKnownWell) {
  EXPECT_EQ(prior_form(0.2, false), PriorForm::kNormal);
  EXPECT_DOUBLE_EQ(prior_z(PriorForm::kNormal, 8.0, 1.6, 11.2), 2.0);
  EXPECT_DOUBLE_EQ(prior_dz(PriorForm::kNormal, 8.0, 1.6, 11.2), 1.0 / 1.6);
}

// A guess of 100 % that is wrong by a factor of ten: 3.3 standard deviations either way, where a normal prior
// says 9 one way and 0.9 the other.
TEST(Prior, IsOfTheOrderOfMagnitudeWhereTheValueIsAGuess) {
  EXPECT_EQ(prior_form(1.0, false), PriorForm::kLogNormal);
  EXPECT_NEAR(prior_z(PriorForm::kLogNormal, 8.0, 8.0, 80.0), std::log(10.0) / std::log(2.0), 1e-12);
  EXPECT_NEAR(prior_z(PriorForm::kLogNormal, 8.0, 8.0, 0.8), -std::log(10.0) / std::log(2.0), 1e-12);
  EXPECT_EQ(prior_z(PriorForm::kLogNormal, 8.0, 8.0, 16.0), 1.0);  // one tolerance up is one sigma
}

// Friction may be absent: that is one tolerance of 100 % away, not infinitely many.
TEST(Prior, OfANumberThatMayBeZeroReachesZero) {
  EXPECT_EQ(prior_form(1.0, true), PriorForm::kLogNormalAbove);
  EXPECT_DOUBLE_EQ(prior_z(PriorForm::kLogNormalAbove, 2e-6, 2e-6, 0.0), -1.0);
  EXPECT_NEAR(prior_z(PriorForm::kLogNormalAbove, 2e-6, 2e-6, 2e-5), 3.3219, 1e-4);
}

TEST(Prior, HasTheDerivativeOfItsDeviation) {
  for (const PriorForm form : {PriorForm::kNormal, PriorForm::kLogNormal, PriorForm::kLogNormalAbove}) {
    for (const double x : {0.5, 3.0, 20.0}) {
      const double h = 1e-6 * x;
      const double slope = (prior_z(form, 2.0, 1.4, x + h) - prior_z(form, 2.0, 1.4, x - h)) / (2.0 * h);
      EXPECT_NEAR(prior_dz(form, 2.0, 1.4, x), slope, 1e-8) << static_cast<int>(form) << " " << x;
    }
  }
}

TEST(Prior, FollowsTheModelFilesTolerance) {
  const Bench bench = simulated_bench({.with = {}, .duration_s = 0.5, .model = {}});
  for (const Unknown& u : unknowns_of(bench.nominal)) {
    const bool guess = u.path == "motor.viscous_friction_Nm_s_per_rad" ||  // 100 %; may be zero
                       u.path == "coulomb_friction.torque_Nm";             // 50 %
    EXPECT_EQ(u.prior_form, guess ? PriorForm::kLogNormalAbove : PriorForm::kNormal) << u.path;
  }
}

}  // namespace
}  // namespace omnihil
