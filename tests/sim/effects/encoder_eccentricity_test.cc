#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

AxisInput turned(double speed_rad_s, double duration_s) {
  AxisInput in = held(CommandKind::kMotorCurrent, 0.0, duration_s);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), speed_rad_s);
  return in;
}

TEST(EncoderEccentricity, AddsItsAmplitudeAQuarterTurnAfterItsZero) {
  SensorPort<double> port;
  port.theta_rotor_rad = port.encoder_angle_rad = std::numbers::pi / 2;
  port.omega_rotor_rad_s = port.measured_speed_rad_s = 10.0;
  const double params[] = {0.01, 0.0};
  find_effect("encoder_eccentricity")->simulate.sensor(nullptr, params, nullptr, port);
  EXPECT_NEAR(port.encoder_angle_rad, std::numbers::pi / 2 + 0.01, 1e-15);
  EXPECT_NEAR(port.measured_speed_rad_s, 10.0, 1e-15);
}

// An encoder on the output of a gear 3:1 errs once per output turn; seen from the rotor three times as much.
TEST(EncoderEccentricity, TurnsWithTheEncodersShaft) {
  SensorPort<double> port;
  port.encoder_turns_per_rotor_turn = 1.0 / 3.0;
  port.theta_rotor_rad = port.encoder_angle_rad = 3.0 * std::numbers::pi / 2;
  const double params[] = {0.01, 0.0};
  find_effect("encoder_eccentricity")->simulate.sensor(nullptr, params, nullptr, port);
  EXPECT_NEAR(port.encoder_angle_rad - port.theta_rotor_rad, 0.03, 1e-14);
}

TEST(EncoderEccentricity, VanishesInTheLimitAndInTheMeanOverATurn) {
  const auto out = run_axis(small_drive(), with({use_of("encoder_eccentricity", {0.01, 0.4})}),
                            turned(2.0 * std::numbers::pi, 1.0));
  double mean = 0.0;
  for (std::size_t n = 1; n < out.size(); ++n)
    mean += (out[n].position_rad - out[n].theta_rotor_rad) / 1000.0;
  EXPECT_NEAR(mean, 0.0, 1e-12);
  const auto tiny = run_axis(small_drive(), with({use_of("encoder_eccentricity", {1e-12, 0.4})}),
                             turned(2.0 * std::numbers::pi, 1.0));
  for (const auto& s : tiny) EXPECT_NEAR(s.position_rad, s.theta_rotor_rad, 2e-12);
}

// The speed that it shows is the slope of the angle that it shows.
TEST(EncoderEccentricity, ShowsASpeedThatFitsItsAngle) {
  const auto out = run_axis(small_drive(), with({use_of("encoder_eccentricity", {0.05, 0.4})}),
                            excite(Excitation::kSteps, 0.3, 1.0));
  double angle = out[0].position_rad;
  for (std::size_t n = 1; n < out.size(); ++n) {
    angle += 0.5e-3 * (out[n - 1].velocity_rad_s + out[n].velocity_rad_s);
  }
  EXPECT_NEAR(angle, out.back().position_rad, 5e-3);
}

// Signature: ripple of the measured speed at order 1, e omega, and none in the current or the true speed.
TEST(EncoderEccentricity, ShowsAsARippleAtOrderOneInProportionToTheSpeed) {
  for (const double speed : {2.0 * std::numbers::pi, 8.0 * std::numbers::pi}) {
    const auto out =
        run_axis(small_drive(), with({use_of("encoder_eccentricity", {0.01, 0.4})}), turned(speed, 2.0));
    const auto line = [&](int order) {
      double re = 0.0, im = 0.0;
      for (std::size_t n = 1; n < out.size(); ++n) {
        re += out[n].velocity_rad_s * std::cos(order * out[n].theta_rotor_rad);
        im += out[n].velocity_rad_s * std::sin(order * out[n].theta_rotor_rad);
      }
      return 2.0 * std::hypot(re, im) / static_cast<double>(out.size() - 1);
    };
    EXPECT_NEAR(line(1), 0.01 * speed, 1e-6 * speed);
    for (const int other : {2, 3, 48}) EXPECT_LT(line(other), 1e-6 * speed) << other;
    for (const auto& s : out) EXPECT_NEAR(s.motor_current_A, 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace omnihil::test
