#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/effects/bench.h"

namespace omnihil::test {
namespace {

// In the middle of the band's edge half of the difference between asked voltage and back-EMF is there.
TEST(PwmDeadBand, GivesHalfInTheMiddleOfItsEdge) {
  BridgePort<double> port;
  port.duty_ratio = 0.05;
  port.bus_voltage_V = 12.0;
  port.voltage_V = 0.6;
  port.back_emf_V = 0.2;
  const double duty = 0.05;
  find_effect("pwm_dead_band")->simulate.bridge(nullptr, &duty, nullptr, port);
  EXPECT_NEAR(port.voltage_V, 0.2 + 0.5 * (0.6 - 0.2), 1e-12);
}

TEST(PwmDeadBand, ChangesNothingAboveItsEdge) {
  const AxisInput in = excite(Excitation::kPrbs, 0.6, 1.0);
  const auto with_it = run_axis(small_drive(), with({use_of("pwm_dead_band", {0.5})}), in);
  const auto without = run_axis(small_drive(), nothing(), in);
  for (std::size_t n = 0; n < with_it.size(); ++n) {
    EXPECT_NEAR(with_it[n].omega_rotor_rad_s, without[n].omega_rotor_rad_s, 1e-9);
  }
}

// Nothing drives, nothing brakes: J domega/dt = -b omega.
TEST(PwmDeadBand, LetsTheRotorCoastWithin) {
  const DriveParams<double> p = small_drive();
  AxisInput in = held(CommandKind::kDuty, 0.02, 2.0);
  in.initial_velocity_rad_s = 100.0;
  const auto out = run_axis(p, with({use_of("pwm_dead_band", {0.05})}), in).back();
  const double rate = p.viscous_friction_Nm_s_per_rad / inertia_at_rotor(p);
  EXPECT_NEAR(out.omega_rotor_rad_s, 100.0 * std::exp(-2.0 * rate), 0.05);
  EXPECT_NEAR(out.motor_current_A, 0.0, 1e-5);
}

// Signature: locked rotor, current over duty: none within 0.9 d, the full line u / R outside 1.1 d.
TEST(PwmDeadBand, ShowsAsNoCurrentBelowADutyAndTheFullLineAbove) {
  DriveParams<double> p = small_drive();
  p.coulomb_friction_Nm = 10.0;
  const double d = 0.05;
  const AxisInput in = excite(Excitation::kCreep, 1.0, 16.0);
  const auto out = run_axis(p, with({use_of("pwm_dead_band", {d})}), in);
  int within = 0, outside = 0;
  for (std::size_t n = 20; n < out.size(); ++n) {
    const double duty = in.command[n - 1], current = out[n].motor_current_A;
    if (std::abs(duty) < 0.88 * d) {
      EXPECT_NEAR(current, 0.0, 1e-4) << duty;
      ++within;
    } else if (std::abs(duty) > 1.12 * d) {
      EXPECT_NEAR(current, duty * 12.0 / 1.2, 2e-3) << duty;
      ++outside;
    }
  }
  EXPECT_GT(within, 1000);
  EXPECT_GT(outside, 1000);
}

}  // namespace
}  // namespace omnihil::test
