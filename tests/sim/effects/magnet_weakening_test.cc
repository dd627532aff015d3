#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

WindingPort<double> winding_at(double rise_K, double coefficient_per_K) {
  WindingPort<double> port;
  port.temperature_rise_K = rise_K;
  port.torque_constant_Nm_per_A = port.back_emf_V_s_per_rad = 0.0255;
  find_effect("magnet_weakening")->simulate.winding(nullptr, &coefficient_per_K, nullptr, port);
  return port;
}

TEST(MagnetWeakening, LosesItsShareOfTheFlux) {
  EXPECT_NEAR(winding_at(60.0, 0.0011).torque_constant_Nm_per_A, 0.0255 * (1.0 - 0.066), 1e-15);
}

TEST(MagnetWeakening, VanishesCold) { EXPECT_EQ(winding_at(0.0, 0.0011).torque_constant_Nm_per_A, 0.0255); }

TEST(MagnetWeakening, KeepsTorqueAndBackEmfEqual) {
  const auto w = winding_at(80.0, 0.002);
  EXPECT_EQ(w.torque_constant_Nm_per_A, w.back_emf_V_s_per_rad);
}

// The thermal model of winding_heating runs along, with its shape parameters, though its coefficient is 0.
TEST(MagnetWeakening, BringsTheTemperatureItNeeds) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  const AxisInput in = held(CommandKind::kMotorCurrent, 2.0, 1.0);
  const auto alone = run_axis(p, with({use_of("magnet_weakening", {0.0011})}), in).back();
  EXPECT_GT(alone.winding_rise_K, 1.0);
  const auto light = run_axis(
      p, with({use_of("magnet_weakening", {0.0011}), use_of("winding_heating", {0.0, 4.0, 0.1})}), in);
  // P R (1 - exp(-t / (R C))), R = 1.2 ohm unheated
  EXPECT_NEAR(light.back().winding_rise_K, 1.2 * 4.0 * 4.0 * (1.0 - std::exp(-1.0 / 0.4)), 0.01);
}

// Signature: heated by a stall, the no-load speed is higher, the stall torque per ampere lower.
TEST(MagnetWeakening, ShowsAsAHigherFreeSpeedWhenHot) {
  const DriveParams<double> p = small_drive();
  const std::vector<EffectUse> uses{use_of("magnet_weakening", {0.0011}),
                                    use_of("winding_heating", {0.00393, 50.0, 2.0})};
  AxisInput in = held(CommandKind::kDuty, 0.5, 24.0, 500.0);
  in.load_torque_Nm.assign(in.time_s.size(), 0.0);
  for (std::size_t n = 0; n < in.time_s.size(); ++n) {
    if (in.time_s[n] > 2.0 && in.time_s[n] < 22.0) in.load_torque_Nm[n] = -0.08;  // 3 A
  }
  const auto out = run_axis(p, with(uses), in);
  const auto& cold = out[990];
  const auto& hot = out.back();
  EXPECT_GT(hot.winding_rise_K, 40.0);
  const auto free_speed = [&](double k, double r) {
    return 6.0 / (k + r * p.viscous_friction_Nm_s_per_rad / k);
  };
  const double k = p.torque_constant_Nm_per_A * (1.0 - 0.0011 * hot.winding_rise_K);
  const double r = p.resistance_ohm * (1.0 + 0.00393 * hot.winding_rise_K);
  // It is still cooling: the speed follows 50 ms late.
  EXPECT_NEAR(hot.omega_rotor_rad_s, free_speed(k, r), 0.1);
  EXPECT_GT(hot.omega_rotor_rad_s, cold.omega_rotor_rad_s * 1.03);
}

}  // namespace
}  // namespace omnihil::test
