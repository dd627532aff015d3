#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

double torque_at(double current_A, double inverse_current_per_A) {
  DriveParams<double> p = small_drive();
  AxisInput in = held(CommandKind::kMotorCurrent, current_A, 0.05);
  in.imposed_velocity_rad_s.assign(in.time_s.size(), 0.0);
  return -run_axis(p, with({use_of("saturation", {inverse_current_per_A})}), in).back().load_torque_Nm;
}

TEST(Saturation, HalvesTheTorqueConstantAtItsCurrent) {
  EXPECT_NEAR(torque_at(20.0, 0.05), 0.5 * 0.0255 * 20.0, 1e-12);
  EXPECT_NEAR(torque_at(10.0, 0.05), 0.8 * 0.0255 * 10.0, 1e-12);  // 1 / (1 + 1/4)
}

TEST(Saturation, VanishesAtSmallCurrents) { EXPECT_NEAR(torque_at(0.01, 0.05), 0.0255 * 0.01, 1e-9); }

TEST(Saturation, IsEvenInTheCurrent) { EXPECT_EQ(torque_at(-7.0, 0.03), -torque_at(7.0, 0.03)); }

// Power that leaves the winding enters the rotor, when driving and when braking.
TEST(Saturation, KeepsTheEnergyBalance) {
  DriveParams<double> p = small_drive();
  const DriveSim<double> sim(p, with({use_of("saturation", {0.1})}), 50e-6);
  auto state = sim.initial_state();
  double electrical = 0, heat = 0, shaft = 0;
  for (int n = 0; n < 4000; ++n) {
    const double before = state.omega_rotor_rad_s;
    const auto r = sim.advance(state, {.kind = CommandKind::kDuty, .setpoint = n < 2000 ? 0.9 : -0.9}, 1);
    electrical += r.electrical_energy_J;
    heat += r.heat_J;
    const double mean = 0.5 * (before + state.omega_rotor_rad_s);
    shaft += (r.mean_shaft_torque_Nm + p.viscous_friction_Nm_s_per_rad * mean) * mean * 50e-6;
  }
  const double magnetic = 0.5 * p.inductance_H * state.current_A * state.current_A;
  EXPECT_NEAR(electrical, heat + shaft + magnetic, 1e-9 * electrical);
}

// Signature: acceleration per ampere falls with the square of the current.
TEST(Saturation, ShowsAsLessAccelerationPerAmpereAtHighCurrent) {
  DriveParams<double> p = small_drive();
  p.viscous_friction_Nm_s_per_rad = 0.0;
  const double j = inertia_at_rotor(p);
  for (const double current : {1.0, 4.0, 9.0}) {
    const auto out =
        run_axis(p, with({use_of("saturation", {0.03})}), held(CommandKind::kMotorCurrent, current, 0.02))
            .back();
    const double per_ampere = out.omega_rotor_rad_s / 0.02 / current;
    // The law sees the current at the start of a sub-step: the first of 400 is not yet saturated.
    EXPECT_NEAR(per_ampere * j / 0.0255, 1.0 / (1.0 + std::pow(0.03 * current, 2)), 3e-4) << current;
  }
}

}  // namespace
}  // namespace omnihil::test
