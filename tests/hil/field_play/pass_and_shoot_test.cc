// Pass and shoot, and the emotional controller of wheels: learning rules, bounds, determinism; statistics by hand.
#include "hil/field_play/pass_and_shoot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "firmware_iface/reference/belbic.h"
#include "hil/loop/model_store.h"

namespace omnihil {
namespace {

const wheel_gains kGains{0.05f, 1.0f, 0.0f};
const motor_constants kMotor{0.4f, 0.03f};
const belbic_rates kRates{10.0f, 100.0f};

wheel_loop_input input_of(float reference, float omega) {
  return {reference, omega, 0.0f, 0.0f, 24.0f, 1e-3f};
}

TEST(Belbic, WithoutErrorItLearnsNothingAndGivesTheFeedForward) {
  belbic_loop loop;
  belbic_reset(&loop);
  const wheel_loop_input in = input_of(300.0f, 300.0f);
  for (int k = 0; k < 100; ++k)
    EXPECT_NEAR(belbic_update(&loop, &kRates, &kGains, &kMotor, &in), 0.03 * 300 / 24, 1e-6);
  EXPECT_EQ(loop.amygdala, 1.0f);
  EXPECT_EQ(loop.orbitofrontal, 0.0f);
}

// One step by hand: S = p e / u, R = S + i I / u, dV = alpha S (R - V S) h, dW = beta S (E - R) h.
TEST(Belbic, OneStepIsTheRule) {
  belbic_loop loop;
  belbic_reset(&loop);
  const wheel_loop_input in = input_of(100.0f, 60.0f);
  belbic_update(&loop, &kRates, &kGains, &kMotor, &in);
  const double s = 0.05 * 40 / 24, integral = 40 * 1e-3, r = s + integral / 24, a = s;
  EXPECT_NEAR(loop.amygdala, 1.0 + 10 * s * (r - a) * 1e-3, 1e-6);
  EXPECT_NEAR(loop.orbitofrontal, 100 * s * (a - r) * 1e-3, 1e-6);
  EXPECT_NEAR(loop.integral_rad, integral, 1e-7);
}

TEST(Belbic, TheAmygdalaNeverForgetsAndTheCortexInhibits) {
  belbic_loop loop;
  belbic_reset(&loop);
  float before = loop.amygdala;
  for (int k = 0; k < 5000; ++k) {
    const wheel_loop_input in = input_of(200.0f + 100.0f * std::sin(0.01f * static_cast<float>(k)), 190.0f);
    belbic_update(&loop, &kRates, &kGains, &kMotor, &in);
    EXPECT_GE(loop.amygdala, before);
    before = loop.amygdala;
  }
  // An answer above the emotion raises W, which lowers the next answer.
  loop = {2.0f, 0.0f, 0.0f, 0.0f};
  const wheel_loop_input in = input_of(100.0f, 60.0f);
  belbic_update(&loop, &kRates, &kGains, &kMotor, &in);
  EXPECT_GT(loop.orbitofrontal, 0.0f);
}

TEST(Belbic, AtTheLimitNothingIsLearnedDeeper) {
  belbic_loop loop;
  belbic_reset(&loop);
  const wheel_loop_input in = input_of(2000.0f, 0.0f);
  for (int k = 0; k < 1000; ++k) EXPECT_EQ(belbic_update(&loop, &kRates, &kGains, &kMotor, &in), 1.0f);
  EXPECT_EQ(loop.integral_rad, 0.0f);
  EXPECT_EQ(loop.amygdala, 1.0f);
}

// Its own motor: J dw/dt = k i - load, i = (u - k w) / R.
TEST(Belbic, BringsALoadedMotorToItsSpeed) {
  belbic_loop loop;
  belbic_reset(&loop);
  double omega = 0.0, most = 0.0;
  const double reference = 200.0, load_Nm = 0.02, inertia = 3e-4;
  for (int k = 0; k < 4000; ++k) {
    const wheel_loop_input in = input_of(static_cast<float>(reference), static_cast<float>(omega));
    const double volt = 24.0 * belbic_update(&loop, &kBelbicRates, &kGains, &kMotor, &in);
    for (int n = 0; n < 10; ++n) omega += 1e-4 * (0.03 * (volt - 0.03 * omega) / 0.4 - load_Nm) / inertia;
    most = std::max(most, omega);
  }
  EXPECT_NEAR(omega, reference, 0.02 * reference);
  EXPECT_LT(most, 1.25 * reference);
}

RobotModel robot() {
  const StoredModel stored = load_robot_model("omni_default", {OMNIHIL_SOURCE_DIR "/models"});
  return *stored.model->robot;
}

TEST(PassAndShoot, TheSameSeedIsTheSamePlay) {
  const PassResult a = play_pass_and_shoot(robot(), MotorLoop::kEmotional, {.seed = 3}),
                   b = play_pass_and_shoot(robot(), MotorLoop::kEmotional, {.seed = 3});
  EXPECT_EQ(a.wheel_rms_rad_s, b.wheel_rms_rad_s);
  EXPECT_EQ(a.goal_s, b.goal_s);
  EXPECT_TRUE(a.kicked);
}

TEST(PassAndShoot, BothControllersPassAndScoreMostly) {
  int scored[2] = {0, 0};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    scored[0] += play_pass_and_shoot(robot(), MotorLoop::kDuty, {.seed = seed}).scored;
    scored[1] += play_pass_and_shoot(robot(), MotorLoop::kEmotional, {.seed = seed}).scored;
  }
  EXPECT_GE(scored[0], 3);
  EXPECT_GE(scored[1], 3);
}

TEST(Statistics, WilsonAndMcNemarByHand) {
  const Share s = wilson_share(8, 10);  // Newcombe 1998: 0.490 to 0.943
  EXPECT_NEAR(s.from, 0.490, 0.001);
  EXPECT_NEAR(s.to, 0.943, 0.001);
  EXPECT_NEAR(mcnemar_p(1, 9), 2.0 * 11.0 / 1024.0, 1e-9);
  EXPECT_EQ(mcnemar_p(0, 0), 1.0);
  EXPECT_EQ(mcnemar_p(5, 5), 1.0);
}

}  // namespace
}  // namespace omnihil
