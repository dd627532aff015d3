#include "sim/drive/averaged_drive.h"

#include <gtest/gtest.h>

#include "tests/sim/drive/phase_bench.h"

namespace omnihil {
namespace {

constexpr Inverter kReal{
    .pwm_frequency_Hz = 20e3, .dead_time_s = 0.5e-6, .switch_resistance_ohm = 0.012, .diode_forward_V = 0.8};

constexpr PwmMode kModes[] = {PwmMode::kComplementary, PwmMode::kHighSideChop, PwmMode::kFastDecay};

TEST(AveragedDrive, EnergyFromTheBusIsHeatAndWorkAndStored) {
  for (const auto& m : {trapezoid_motor(), sine_motor()})
    for (const PwmMode mode : kModes) {
      const AveragedDrive d = make_averaged_drive(m, kReal, 50e-6, 0.0);
      PhaseState x;
      PhaseFlow flow;
      for (int k = 0; k < 800; ++k) {
        const double duty = k < 400 ? 0.6 : (k < 700 ? 0.3 : 0.0);
        advance_averaged(d, x, six_step(8 * x.theta_rotor_rad, duty, mode),
                         {.bus_voltage_V = 24.0, .tau_load_Nm = 0.01}, flow);
      }
      const double gap_J = energy_gap_J(d.circuit, flow, stored_J(d.circuit, x));
      EXPECT_LT(std::abs(gap_J), 1e-6 * std::abs(flow.bus_J));
    }
}

// Rotor held at a speed by the bench: mean current that a duty drives through one pair, both ways of
// reckoning.
struct Means {
  double averaged_A, switched_A;
};
Means pair_current(double duty, double emf_V, PwmMode mode, const Inverter& inverter) {
  PhaseMotor<double> m = trapezoid_motor();
  m.pole_pairs = 1;  // so slow in electrical angle that the pair stays the pair
  m.flux_linkage_Wb *= 8;
  const double omega = emf_V / 0.0295;
  const double start_rad = 0.0;  // sector 0: b high, c low, both in the middle of their tops
  const BridgeCommand c = block_command(1, 2, duty, mode);
  const PhaseInput in{.bus_voltage_V = 24.0, .speed_is_imposed = true};
  const AveragedDrive a = make_averaged_drive(m, inverter, 50e-6, 0.0);
  const SwitchedDrive s = make_switched_drive(m, inverter, {.max_step_s = 5e-6});
  PhaseState x;
  SwitchedState y;
  x.omega_rotor_rad_s = y.motor.omega_rotor_rad_s = omega;
  PhaseFlow fx, fy;
  for (int k = 0; k < 400; ++k) {
    if (k == 380) fx = fy = {};
    x.theta_rotor_rad = y.motor.theta_rotor_rad = start_rad;
    advance_averaged(a, x, c, in, fx);
    advance_period(s, y, c, in, 0.5, fy);
  }
  return {fx.charge_C[1] / fx.time_s, fy.charge_C[1] / fy.time_s};
}

TEST(AveragedDrive, MeanCurrentIsThatOfTheSwitchedBridge) {
  for (const PwmMode mode : kModes)
    for (const double duty : {0.05, 0.2, 0.5, 0.8, 1.0})
      for (const double emf_V : {2.0, 6.0, 15.0}) {
        const Means i = pair_current(duty, emf_V, mode, kReal);
        // 5 % of the mean or 40 mA: discontinuous current is reckoned as a triangle, without R
        EXPECT_NEAR(i.averaged_A, i.switched_A, 0.05 * std::abs(i.switched_A) + 0.04)
            << static_cast<int>(mode) << " " << duty << " " << emf_V;
      }
}

TEST(AveragedDrive, ChoppedModesKeepCurrentDiscontinuousWhereComplementaryBrakes) {
  EXPECT_LT(pair_current(0.2, 15.0, PwmMode::kComplementary, kReal).switched_A, -10.0);
  EXPECT_GT(pair_current(0.2, 15.0, PwmMode::kHighSideChop, kReal).switched_A, 0.0);
  EXPECT_LT(pair_current(0.2, 15.0, PwmMode::kHighSideChop, kReal).switched_A, 0.5);
}

TEST(AveragedDrive, CoastModeHasItsDeadBand) {
  // fast decay at standstill: the mean current grows with the duty squared, far below d V / R
  const double slow = pair_current(0.1, 0.0, PwmMode::kComplementary, kReal).switched_A;
  const double coast = pair_current(0.1, 0.0, PwmMode::kFastDecay, kReal).switched_A;
  EXPECT_LT(coast, 0.1 * slow);
  const double twice = pair_current(0.2, 0.0, PwmMode::kFastDecay, kReal).switched_A;
  EXPECT_NEAR(twice / coast, 4.0, 0.2);
}

TEST(AveragedDrive, HalvingTheStepQuartersTheErrorWithoutEvents) {
  const auto run = [](double h_s) {
    const AveragedDrive d = make_averaged_drive(sine_motor(), {}, h_s, 0.0);
    PhaseState x;
    PhaseFlow flow;
    const int n = static_cast<int>(std::lround(0.01 / h_s));
    for (int k = 0; k < n; ++k) {
      const double a = 2.0 * std::numbers::pi * 40.0 * (k + 0.5) * h_s + 1.6;
      advance_averaged(d, x,
                       sine_command({0.5 + 0.2 * std::cos(a), 0.5 + 0.2 * std::cos(a - 120 * kDegree),
                                     0.5 + 0.2 * std::cos(a + 120 * kDegree)}),
                       {.bus_voltage_V = 24.0}, flow);
    }
    return x;
  };
  const auto truth = run(0.3125e-6);
  const auto error = [&](double h_s) {
    const auto x = run(h_s);
    return std::abs(x.omega_rotor_rad_s - truth.omega_rotor_rad_s) +
           std::abs(x.current_A[0] - truth.current_A[0]);
  };
  const double ratio = error(20e-6) / error(10e-6);
  EXPECT_GT(ratio, 3.5);
  EXPECT_LT(ratio, 4.5);
}

}  // namespace
}  // namespace omnihil
