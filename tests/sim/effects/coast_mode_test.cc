#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

constexpr double kPwm_Hz = 20e3;

double mean_voltage(double duty, double bus_V, double emf_V, std::vector<double> p) {
  BridgePort<double> port;
  port.duty_ratio = duty;
  port.bus_voltage_V = bus_V;
  port.voltage_V = duty * bus_V;
  port.back_emf_V = emf_V;
  port.pwm_frequency_Hz = kPwm_Hz;
  find_effect("coast_mode")->simulate.bridge(nullptr, p.data(), nullptr, port);
  return port.voltage_V;
}

// The same winding switched for real: L di/dt = u - R i - e with u = V in the pulse, then -r V until the current
// is gone, then nothing flows. Mean of the voltage at the winding over the last of many periods.
double switched(double duty, double bus_V, double emf_V, double time_constant_s, double r) {
  constexpr int kSteps = 4000, kPeriods = 400;
  const double resistance = 1.2, inductance = resistance * time_constant_s, h = 1.0 / kPwm_Hz / kSteps;
  double current = 0.0, sum = 0.0;
  for (int n = 0; n < kSteps * kPeriods; ++n) {
    const bool on = n % kSteps < duty * kSteps;
    double u = on ? bus_V : (current > 0.0 ? -r * bus_V : emf_V);
    const double next = current + h * (u - resistance * current - emf_V) / inductance;
    if (!on && current > 0.0 && next < 0.0) u = emf_V;
    current = !on ? std::max(next, 0.0) : next;
    if (n >= kSteps * (kPeriods - 1)) sum += u / kSteps;
  }
  return sum;
}

TEST(CoastMode, HasTheMeanVoltageOfTheSwitchedWinding) {
  for (const double duty : {0.1, 0.4, 0.8}) {
    for (const double emf : {0.5, 4.0, 10.0}) {
      for (const double tau : {1e-5, 1e-4, 1e-3}) {
        for (const double r : {0.05, 1.0}) {
          EXPECT_NEAR(mean_voltage(duty, 12.0, emf, {1.0, tau, r}), switched(duty, 12.0, emf, tau, r), 0.02)
              << duty << " " << emf << " " << tau << " " << r;
        }
      }
    }
  }
}

// No inductance: the current is gone at once, u = D V + (1 - D) e, and so i = D (V - e) / R.
TEST(CoastMode, WithoutInductanceTheOffTimeCarriesNothing) {
  EXPECT_NEAR(mean_voltage(0.3, 12.0, 5.0, {1.0, 1e-7, 0.0}), 0.3 * 12.0 + 0.7 * 5.0, 0.01);
  EXPECT_NEAR(mean_voltage(-0.3, 12.0, -5.0, {1.0, 1e-7, 0.0}), -0.3 * 12.0 - 0.7 * 5.0, 0.01);
}

// Half of it: half of the difference to the braking bridge.
TEST(CoastMode, MixesWithBrakingByItsShare) {
  const double braking = 0.3 * 12.0, coasting = mean_voltage(0.3, 12.0, 5.0, {1.0, 1e-4, 0.3});
  EXPECT_NEAR(mean_voltage(0.3, 12.0, 5.0, {0.5, 1e-4, 0.3}), 0.5 * (braking + coasting), 1e-12);
}

// Duty 0, all switches open: J domega/dt = -b omega.
TEST(CoastMode, LetsTheRotorCoastAtDutyZero) {
  const DriveParams<double> p = small_drive();
  AxisInput in = held(CommandKind::kDuty, 0.0, 2.0);
  in.initial_velocity_rad_s = 100.0;
  const auto out = run_axis(p, with({use_of("coast_mode", {1.0, 4.7e-4, 1.0})}), in).back();
  const double rate = p.viscous_friction_Nm_s_per_rad / inertia_at_rotor(p);
  EXPECT_NEAR(out.omega_rotor_rad_s, 100.0 * std::exp(-2.0 * rate), 0.05);
}

// Signature: without inductance D (V - e) k / R = b omega: omega = V / k D / (D + b R / k^2), a hyperbola that
// bends to the top speed where the braking bridge gives a straight line.
TEST(CoastMode, ShowsAsASpeedThatBendsTowardsTheTop) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 1e-4;
  p.pwm_frequency_Hz = 200.0;  // the current is gone after 1/50000 of the period
  const double k = p.torque_constant_Nm_per_A;
  const double loss = p.viscous_friction_Nm_s_per_rad * p.resistance_ohm / (k * k);
  for (const double duty : {0.05, 0.2, 0.6, -0.2}) {
    const auto out =
        run_axis(p, with({use_of("coast_mode", {1.0, 1e-7, 0.0})}), held(CommandKind::kDuty, duty, 8.0))
            .back();
    EXPECT_NEAR(out.omega_rotor_rad_s, 12.0 / k * duty / (std::abs(duty) + loss), 0.05) << duty;
  }
}

}  // namespace
}  // namespace omnihil::test
