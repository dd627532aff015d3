// DC-equivalent, averaged and switched models of one motor, at the same duty and load: speed and current
// agree within 1 % where they must: where commutation is short against a block of 60 electrical degrees
// (light load, small inductance) and the PWM's ripple does not make the floating phase's diode conduct for
// long.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sim/drive/phase_bench.h"

namespace omnihil {
namespace {

constexpr double kBus_V = 24.0;
constexpr Inverter kBridge{.pwm_frequency_Hz = 80e3, .diode_forward_V = 0.8};

struct Steady {
  double omega_rad_s, current_A;  // means over the second half
};

// The equivalent DC motor's steady state: u = R i + k omega, k i = b omega + tau.
Steady dc(const MotorParams& m, double voltage_V, double load_Nm) {
  const double k = m.torque_constant_Nm_per_A, b = m.viscous_friction_Nm_s_per_rad;
  const double omega = (voltage_V * k / m.resistance_ohm - load_Nm) / (k * k / m.resistance_ohm + b);
  return {omega, (voltage_V - k * omega) / m.resistance_ohm};
}

// Means of speed and of the equivalent current tau / k over the end of a run from near the steady state.
template <typename Step>
Steady settle(double k, int periods, Step step) {
  PhaseFlow flow;
  for (int n = 0; n < periods; ++n) {
    if (n == periods / 2) flow = {};
    step(flow);
  }
  return {flow.angle_rad / flow.time_s, flow.impulse_Nm_s / flow.time_s / k};
}

// Between the two ways a real six-step departs from its DC-equivalent: a large inductance makes commutation
// long (see below), a small one lets the floating phase's diode conduct in every off-time of the PWM.
MotorParams six_step_motor() {
  MotorParams m = sheet_motor();
  m.inductance_H = 0.2e-3 * m.resistance_ohm;
  m.viscous_friction_Nm_s_per_rad = 5.4e-6;
  return m;
}

Steady run_averaged(const PhaseMotor<double>& m, const Inverter& inverter, double duty, double load_Nm,
                    double omega) {
  const double step_s = 0.25 / inverter.pwm_frequency_Hz;  // looks at the Hall sensors four times per period
  const AveragedDrive d = make_averaged_drive(m, inverter, step_s, 0.0);
  const double k = torque_constant_Nm_per_A(m, Commutation::kBlock);
  PhaseState x;
  x.omega_rotor_rad_s = omega;
  return settle(k, 100000, [&](PhaseFlow& flow) {
    advance_averaged(d, x, six_step(8 * x.theta_rotor_rad, duty, PwmMode::kComplementary),
                     {.bus_voltage_V = kBus_V, .tau_load_Nm = load_Nm}, flow);
  });
}

Steady run_switched(const PhaseMotor<double>& m, const Inverter& inverter, double duty, double load_Nm,
                    double omega) {
  const SwitchedDrive d = make_switched_drive(m, inverter, {.max_step_s = 5e-6});
  const double k = torque_constant_Nm_per_A(m, Commutation::kBlock);
  SwitchedState x;
  x.motor.omega_rotor_rad_s = omega;
  return settle(k, 25000, [&](PhaseFlow& flow) {
    advance_period(d, x, six_step(8 * x.motor.theta_rotor_rad, duty, PwmMode::kComplementary),
                   {.bus_voltage_V = kBus_V, .tau_load_Nm = load_Nm}, 0.5, flow);
  });
}

const BackEmf kWideTop{BackEmfShape::kTrapezoid, 140 * kDegree};

TEST(Agreement, SixStepAveragedAndSwitchedAgainstDcOverTheDutyRange) {
  const MotorParams sheet = six_step_motor();
  const PhaseMotor<double> m = phase_motor_of(sheet, Commutation::kBlock, kWideTop);
  const double load_Nm = 0.005;
  for (double duty = 0.1; duty < 1.01; duty += 0.15) {
    const Steady expected = dc(sheet, duty * kBus_V, load_Nm);
    const Steady a = run_averaged(m, kBridge, duty, load_Nm, expected.omega_rad_s);
    const Steady s = run_switched(m, kBridge, duty, load_Nm, expected.omega_rad_s);
    EXPECT_NEAR(a.omega_rad_s, expected.omega_rad_s, 0.01 * expected.omega_rad_s) << duty;
    EXPECT_NEAR(a.current_A, expected.current_A, 0.01 * expected.current_A) << duty;
    EXPECT_NEAR(s.omega_rad_s, expected.omega_rad_s, 0.01 * expected.omega_rad_s) << duty;
    EXPECT_NEAR(s.current_A, expected.current_A, 0.01 * expected.current_A) << duty;
  }
}

TEST(Agreement, CommutationTakesTheVoltageOfARectifiersOverlap) {
  // Under load at speed the DC-equivalent must fail, by a known amount: each of six commutations per
  // electrical turn costs the pair L I volt-seconds, I the current that changes its phase; (3/pi) omega_e L I
  // in the mean, as in a bridge rectifier.
  const MotorParams sheet = six_step_motor();
  const PhaseMotor<double> m = phase_motor_of(sheet, Commutation::kBlock, kWideTop);
  const SwitchedDrive d = make_switched_drive(m, kBridge, {.max_step_s = 5e-6});
  for (const double load_Nm : {0.03, 0.06}) {
    SwitchedState x;
    x.motor.omega_rotor_rad_s = dc(sheet, kBus_V, load_Nm).omega_rad_s;
    int sector = -1, commutations = 0;
    double sum_A = 0.0;
    const Steady s = settle(0.0295, 25000, [&](PhaseFlow& flow) {
      const int now = hall_sector(hall_code({}, 8 * x.motor.theta_rotor_rad));
      if (now != sector) {
        const auto& i = x.motor.current_A;
        sum_A += std::max({std::abs(i[0]), std::abs(i[1]), std::abs(i[2])});
        ++commutations;
        sector = now;
      }
      advance_period(d, x, six_step(8 * x.motor.theta_rotor_rad, 1.0, PwmMode::kComplementary),
                     {.bus_voltage_V = kBus_V, .tau_load_Nm = load_Nm}, 0.5, flow);
    });
    const double at_change_A = sum_A / commutations;
    const double overlap_V = 3.0 / std::numbers::pi * 8 * s.omega_rad_s * m.inductance_q_H * at_change_A;
    const double lost_V = kBus_V - sheet.resistance_ohm * s.current_A - 0.0295 * s.omega_rad_s;
    EXPECT_NEAR(lost_V, overlap_V, 0.05 * overlap_V) << load_Nm;
  }
}

// Sinusoidal drive without a controller: the voltage that holds i_d at zero, turned with the rotor.
Steady run_sine(const PhaseMotor<double>& m, const Inverter& inverter, double v_q, double load_Nm,
                const Steady& from) {
  const double k = torque_constant_Nm_per_A(m, Commutation::kSinusoidal);
  const SwitchedDrive d = make_switched_drive(m, inverter, {.max_step_s = 5e-6});
  SwitchedState x;
  x.motor.omega_rotor_rad_s = from.omega_rad_s;
  return settle(k, 25000, [&](PhaseFlow& flow) {
    const double we = 8 * x.motor.omega_rotor_rad_s, i_q = from.current_A * 2.0 / std::sqrt(3.0);
    const double v_d = -we * m.inductance_q_H * i_q;
    const double mid = 8 * x.motor.theta_rotor_rad + 0.5 * we / inverter.pwm_frequency_Hz;
    std::array<double, 3> v{};
    for (int p = 0; p < 3; ++p) {
      const double a = mid - p * 120 * kDegree;
      v[static_cast<std::size_t>(p)] = v_d * std::cos(a) - v_q * std::sin(a);
    }
    const double shift =  // both rails equally far: the star point takes what is common
        0.5 * (std::max({v[0], v[1], v[2]}) + std::min({v[0], v[1], v[2]}));
    for (double& u : v) u = 0.5 + (u - shift) / kBus_V;
    advance_period(d, x, sine_command(v), {.bus_voltage_V = kBus_V, .tau_load_Nm = load_Nm}, 0.5, flow);
  });
}

TEST(Agreement, SinusoidalDqAndSwitchedAgainstDcOverTheVoltageRange) {
  const MotorParams sheet = sheet_motor();
  const PhaseMotor<double> m = sine_motor();
  const double load_Nm = 0.05;
  for (double v_q = 2.0; v_q < 13.6; v_q += 2.3) {
    // U = sqrt(3) v_q
    const Steady expected = dc(sheet, std::sqrt(3.0) * v_q, load_Nm);
    const Steady s = run_sine(m, kBridge, v_q, load_Nm, expected);
    DqState<double> x;
    x.omega_rotor_rad_s = expected.omega_rad_s;
    for (int n = 0; n < 8000; ++n) {
      const double we = 8 * x.omega_rotor_rad_s;
      advance_dq(m, x, {.v_d_V = -we * m.inductance_q_H * x.i_q_A, .v_q_V = v_q, .tau_load_Nm = load_Nm},
                 50e-6);
    }
    EXPECT_NEAR(x.omega_rotor_rad_s, expected.omega_rad_s, 1e-3 * expected.omega_rad_s);
    EXPECT_NEAR(0.5 * std::sqrt(3.0) * x.i_q_A, expected.current_A, 1e-3 * expected.current_A);
    EXPECT_NEAR(s.omega_rad_s, expected.omega_rad_s, 0.01 * expected.omega_rad_s);
    EXPECT_NEAR(s.current_A, expected.current_A, 0.01 * expected.current_A);
  }
}

}  // namespace
}  // namespace omnihil
