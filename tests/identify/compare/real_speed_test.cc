// Free-running simulations of published recordings, speed against duty: the figures that the plain model has
// on them elsewhere, and those with the effects they lack. Published figures: fit / holdout / extrapolation,
// rad/s.
#include "tests/identify/real_bench.h"

namespace omnihil {
namespace {

class RealSpeed : public RealTest {};

TEST_F(RealSpeed, NominalModelsHaveTheirPublishedErrors) {
  const RealSet left("micromouse_wheels_left"), right("micromouse_wheels_right"), pwm("kmutt_pwm_rate"),
      motor("kmutt_dc_motor"), bldc("utcn_bldc");
  expect_same(left.rmse(left.nominal, Split::kTraining, "velocity"), 11.0);
  expect_same(left.rmse(left.nominal, Split::kValidation, "velocity"), 8.90);
  expect_same(left.rmse(left.nominal, Split::kExtrapolation, "velocity"), 3.49);
  expect_same(right.rmse(right.nominal, Split::kTraining, "velocity"), 13.2);
  expect_same(right.rmse(right.nominal, Split::kValidation, "velocity"), 10.1);
  expect_same(right.rmse(right.nominal, Split::kExtrapolation, "velocity"), 4.10);
  expect_same(pwm.rmse(pwm.nominal, Split::kTraining, "velocity"), 9.64);
  expect_same(pwm.rmse(pwm.nominal, Split::kExtrapolation, "velocity"), 9.22);
  expect_same(motor.rmse(motor.nominal, Split::kTraining, "velocity"), 7.49);
  expect_same(motor.rmse(motor.nominal, Split::kValidation, "velocity"), 6.88);
  expect_same(bldc.rmse(bldc.nominal, Split::kTraining, "velocity"), 23.6);
  expect_same(bldc.rmse(bldc.nominal, Split::kValidation, "velocity"), 21.4);
}

TEST_F(RealSpeed, ADutyBeyondOneIsClippedByTheBaseModel) {
  // published for a model that does not clip: 64.2
  const RealSet motor("kmutt_dc_motor");
  EXPECT_LT(motor.rmse(motor.nominal, Split::kExtrapolation, "velocity"), 8.0);
}

TEST_F(RealSpeed, PlainModelsFitAsWellAsPublished) {
  const RealSet left("micromouse_wheels_left"), right("micromouse_wheels_right"), pwm("kmutt_pwm_rate"),
      motor("kmutt_dc_motor");
  const Candidate l = left.fitted({}).model, r = right.fitted({}).model, p = pwm.fitted({}).model,
                  m = motor.fitted({}).model;
  expect_same(left.rmse(l, Split::kTraining, "velocity"), 9.80);
  expect_same(left.rmse(l, Split::kValidation, "velocity"), 8.59);
  expect_at_most(left.rmse(l, Split::kExtrapolation, "velocity"), 4.05);
  expect_same(right.rmse(r, Split::kTraining, "velocity"), 10.2);
  expect_same(right.rmse(r, Split::kValidation, "velocity"), 8.72);
  expect_at_most(right.rmse(r, Split::kExtrapolation, "velocity"), 4.21);
  expect_same(pwm.rmse(p, Split::kTraining, "velocity"), 6.24);
  expect_same(pwm.rmse(p, Split::kExtrapolation, "velocity"), 5.53);
  expect_same(motor.rmse(m, Split::kTraining, "velocity"), 7.39);
  expect_same(motor.rmse(m, Split::kValidation, "velocity"), 6.96);
}

TEST_F(RealSpeed, DryFrictionIsWhatTheBrushedMotorLacked) {
  // best known, four parameters: 3.94 / 4.12 / 3.15
  const RealSet motor("kmutt_dc_motor");
  const Candidate c = motor.fitted({"coulomb_friction"}).model;
  expect_at_most(motor.rmse(c, Split::kTraining, "velocity"), 3.94, 0.0);
  expect_at_most(motor.rmse(c, Split::kValidation, "velocity"), 4.12, 0.0);
  expect_at_most(motor.rmse(c, Split::kExtrapolation, "velocity"), 3.15, 0.10);
}

}  // namespace
}  // namespace omnihil
