#include "sim/drive/switched_drive.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/sim/drive/phase_bench.h"

namespace omnihil {
namespace {

constexpr Inverter kIdeal{.pwm_frequency_Hz = 20e3};
constexpr Inverter kReal{
    .pwm_frequency_Hz = 20e3, .dead_time_s = 0.5e-6, .switch_resistance_ohm = 0.012, .diode_forward_V = 0.8};

const PhaseMotor<double> kMotors[] = {trapezoid_motor(), sine_motor()};
constexpr PwmMode kModes[] = {PwmMode::kComplementary, PwmMode::kHighSideChop, PwmMode::kFastDecay};

TEST(PhaseCircuit, OnePhasePairAtStandstillIsOneExponential) {
  const PhaseMotor<double> m = trapezoid_motor();
  const PhaseCircuit c = make_phase_circuit(m, 0.012, 20e-6, 1e3);  // too heavy to move
  PhaseState x;
  PhaseFlow flow;
  const std::array<Leg, 3> legs = {leg_of(kReal, LegState::kHigh, 24.0), leg_of(kReal, LegState::kLow, 24.0),
                                   leg_of(kReal, LegState::kOff, 24.0)};
  for (int k = 0; k < 10; ++k) advance_circuit(c, x, legs, {.bus_voltage_V = 24.0}, 20e-6, flow);
  // i = V / (R_ll + 2 R_on) (1 - exp(-t (R_ll + 2 R_on) / L_ll))
  const double loop_ohm = 0.447 + 2 * 0.012;
  const double expected = 24.0 / loop_ohm * (1.0 - std::exp(-200e-6 * loop_ohm / 0.243e-3));
  EXPECT_NEAR(x.current_A[0], expected, 1e-9);  // the rotor does give way a little
  EXPECT_EQ(x.current_A[0], -x.current_A[1]);
  EXPECT_EQ(x.current_A[2], 0.0);
}

// Of three phases that conduct, by two switches and a diode, and of two when the diode's current has ended.
TEST(PhaseCircuit, SeveralStretchesAreOneAfterTheOther) {
  const PhaseMotor<double> m = sine_motor();
  const PhaseCircuit c = make_phase_circuit(m, 0.012, 5e-6, 0.0);
  const std::array<Leg, 3> legs = {leg_of(kReal, LegState::kHigh, 24.0), leg_of(kReal, LegState::kLow, 24.0),
                                   leg_of(kReal, LegState::kOff, 24.0)};
  PhaseState at_once, by_one;
  at_once.current_A = by_one.current_A = {3.0, -5.0, 2.0};
  at_once.omega_rotor_rad_s = by_one.omega_rotor_rad_s = 100.0;
  PhaseFlow sums, sums_by_one;
  const PhaseStretch stretch = stretch_of(c, 5e-6);
  const PhaseInput in{.bus_voltage_V = 24.0, .tau_load_Nm = 0.01};
  advance_circuit(c, at_once, legs, in, stretch, sums, 40);
  for (int k = 0; k < 40; ++k) advance_circuit(c, by_one, legs, in, stretch, sums_by_one);
  EXPECT_EQ(at_once.current_A, by_one.current_A);
  EXPECT_EQ(at_once.theta_rotor_rad, by_one.theta_rotor_rad);
  EXPECT_EQ(sums.mechanical_J, sums_by_one.mechanical_J);
  EXPECT_EQ(sums.events, 1);
  EXPECT_EQ(at_once.current_A[2], 0.0);
}

TEST(PhaseCircuit, FreewheelingCurrentStopsAtExactlyZeroAndAtTheRightInstant) {
  const PhaseMotor<double> m = trapezoid_motor();
  const PhaseCircuit c = make_phase_circuit(m, 0.012, 20e-6, 1e3);
  PhaseState x;
  x.current_A = {5.0, -5.0, 0.0};
  PhaseFlow flow;
  const Leg off = leg_of(kReal, LegState::kOff, 24.0);
  // both diodes against the bus: i_inf = -(24 + 2 * 0.8) / R;  zero after tau ln(1 - i_0 / i_inf)
  const double loop_ohm = 0.447 + 2 * 0.012, tau = 0.243e-3 / loop_ohm, settled = -(24.0 + 1.6) / loop_ohm;
  const double zero_s = tau * std::log(1.0 - 5.0 / settled);
  for (int k = 0; k < 20; ++k) advance_circuit(c, x, {off, off, off}, {.bus_voltage_V = 24.0}, 20e-6, flow);
  EXPECT_EQ(x.current_A[0], 0.0);
  EXPECT_EQ(x.current_A[1], 0.0);
  EXPECT_EQ(flow.events, 1);
  EXPECT_NEAR(flow.bus_charge_C, -flow.charge_C[0], 1e-15);  // all of it into the bus
  EXPECT_NEAR(flow.charge_C[0], settled * zero_s + (5.0 - settled) * tau * (1.0 - std::exp(-zero_s / tau)),
              1e-12);
  EXPECT_GT(zero_s, 20e-6);
}

TEST(PhaseCircuit, CoastingRotorRectifiesOnlyAboveTheBus) {
  const PhaseMotor<double> m = trapezoid_motor();
  const PhaseCircuit c = make_phase_circuit(m, 0.012, 5e-6, 0.0);
  const Leg off = leg_of(kReal, LegState::kOff, 24.0);
  const double limit_rad_s = (24.0 + 1.6) / 0.0295;  // k omega = bus + two diodes
  for (const double factor : {0.98, 1.05}) {
    PhaseState x;
    x.omega_rotor_rad_s = factor * limit_rad_s;
    PhaseFlow flow;
    for (int k = 0; k < 400; ++k)
      advance_circuit(c, x, {off, off, off}, {.bus_voltage_V = 24.0, .speed_is_imposed = true}, 5e-6, flow);
    if (factor < 1.0) {
      EXPECT_EQ(flow.square_A2_s, 0.0);
    } else {
      EXPECT_LT(flow.bus_charge_C, -1e-4 * flow.time_s);
      EXPECT_LT(flow.impulse_Nm_s, 0.0);  // brakes
      EXPECT_NEAR(flow.drop_J, -2 * 0.8 * flow.bus_charge_C, 0.35 * flow.drop_J);
    }
  }
}

TEST(PhaseCircuit, WhatIsCommonToAllPhasesDrivesNoCurrent) {
  // all three legs high, or all low: the same short circuit of the windings
  const PhaseCircuit c = make_phase_circuit(sine_motor(), 0.0, 5e-6, 0.0);
  PhaseState a, b;
  a.omega_rotor_rad_s = b.omega_rotor_rad_s = 200.0;
  PhaseFlow fa, fb;
  const Leg high = leg_of(kIdeal, LegState::kHigh, 24.0), low = leg_of(kIdeal, LegState::kLow, 24.0);
  for (int k = 0; k < 200; ++k) {
    advance_circuit(c, a, {high, high, high}, {.bus_voltage_V = 24.0}, 5e-6, fa);
    advance_circuit(c, b, {low, low, low}, {.bus_voltage_V = 24.0}, 5e-6, fb);
  }
  EXPECT_NEAR(a.current_A[0], b.current_A[0], 1e-9);
  EXPECT_LT(a.omega_rotor_rad_s, 200.0);
  EXPECT_EQ(fb.bus_J, 0.0);
}

// A start, a step of the duty and a coast: what the energy balance leaves over, relative to what went in.
double energy_gap_ratio(const PhaseMotor<double>& m, const Inverter& inverter, PwmMode mode,
                        double max_step_s) {
  const SwitchedDrive d = make_switched_drive(m, inverter, {.max_step_s = max_step_s});
  SwitchedState x;
  PhaseFlow flow;
  for (int k = 0; k < 800; ++k) {
    const double theta = 8 * x.motor.theta_rotor_rad;
    const BridgeCommand c = k < 700 ? six_step(theta, k < 400 ? 0.6 : 0.3, mode) : BridgeCommand{};
    advance_period(d, x, c, {.bus_voltage_V = 24.0, .tau_load_Nm = 0.01}, 0.5, flow);
  }
  EXPECT_EQ(x.motor.current_A[0] + x.motor.current_A[1] + x.motor.current_A[2], 0.0);
  EXPECT_GT(x.motor.omega_rotor_rad_s, 50.0);
  return energy_gap_J(d.circuit, flow, stored_J(d.circuit, x.motor)) / std::abs(flow.bus_J);
}

TEST(SwitchedDrive, EnergyFromTheBusIsHeatAndWorkAndStored) {
  for (const auto& m : kMotors)
    for (const PwmMode mode : kModes)
      for (const Inverter& inverter : {kIdeal, kReal})
        EXPECT_LT(std::abs(energy_gap_ratio(m, inverter, mode, 5e-6)), 1e-6);
}

TEST(SwitchedDrive, HalvingTheStepQuartersTheError) {
  // Sinusoidal drive, so that nothing but the step length changes where the boundaries are.
  const auto run = [](double max_step_s) {
    const SwitchedDrive d = make_switched_drive(sine_motor(), kIdeal, {.max_step_s = max_step_s});
    SwitchedState x;
    PhaseFlow flow;
    for (int k = 0; k < 200; ++k) {
      const double a = 2.0 * std::numbers::pi * 40.0 * k * 50e-6 + 1.6;
      advance_period(d, x,
                     sine_command({0.5 + 0.2 * std::cos(a), 0.5 + 0.2 * std::cos(a - 120 * kDegree),
                                   0.5 + 0.2 * std::cos(a + 120 * kDegree)}),
                     {.bus_voltage_V = 24.0}, 0.5, flow);
    }
    return x.motor;
  };
  // pieces between boundaries are cut in powers of two, so that halving halves all of them
  const auto truth = run(0.05e-6);
  const auto error = [&](double h_s) {
    const auto x = run(h_s);
    return std::abs(x.omega_rotor_rad_s - truth.omega_rotor_rad_s) +
           std::abs(x.current_A[0] - truth.current_A[0]);
  };
  const double ratio = error(4e-6) / error(2e-6);
  EXPECT_GT(ratio, 3.0);
  EXPECT_LT(ratio, 5.0);
}

TEST(SwitchedDrive, DutyOneHoldsTheLegOnAndZeroHoldsItOff) {
  const SwitchedDrive d = make_switched_drive(trapezoid_motor(), kReal, {.extra_inertia_kg_m2 = 1e3});
  SwitchedState x;
  PhaseFlow flow;
  for (int k = 0; k < 200; ++k)
    advance_period(d, x, block_command(0, 1, 1.0, PwmMode::kComplementary), {.bus_voltage_V = 2.0}, 0.5,
                   flow);
  EXPECT_NEAR(x.motor.current_A[0], 2.0 / (0.447 + 0.024), 1e-6);
  for (int k = 0; k < 400; ++k)
    advance_period(d, x, block_command(0, 1, 0.0, PwmMode::kHighSideChop), {.bus_voltage_V = 2.0}, 0.5, flow);
  EXPECT_EQ(x.motor.current_A[0], 0.0);  // the diode let it come to rest
}

struct Edges : SwitchingListener {
  std::vector<std::pair<double, LegState>> leg0;
  void piece(double time_s, const std::array<LegState, 3>& legs, const PhaseState&) override {
    if (leg0.empty() || leg0.back().second != legs[0]) leg0.emplace_back(time_s, legs[0]);
  }
};

TEST(SwitchedDrive, DeadTimeKeepsBothSwitchesOffAfterEachEdge) {
  const SwitchedDrive d = make_switched_drive(trapezoid_motor(), kReal, {});
  SwitchedState x;
  PhaseFlow flow;
  const BridgeCommand c = block_command(0, 1, 0.4, PwmMode::kComplementary);
  advance_period(d, x, c, {.bus_voltage_V = 24.0}, 0.5, flow);
  Edges edges;
  advance_period(d, x, c, {.bus_voltage_V = 24.0}, 0.5, flow, &edges);
  // T = 50 us, on from 15 to 35 us
  ASSERT_EQ(edges.leg0.size(), 5u);
  const double at[] = {0.0, 15e-6, 15.5e-6, 35e-6, 35.5e-6};
  const LegState is[] = {LegState::kLow, LegState::kOff, LegState::kHigh, LegState::kOff, LegState::kLow};
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(edges.leg0[k].first, at[k], 1e-12);
    EXPECT_EQ(edges.leg0[k].second, is[k]);
  }
}

TEST(SwitchedDrive, PulseShorterThanTheDeadTimeIsLost) {
  const SwitchedDrive d = make_switched_drive(trapezoid_motor(), kReal, {});
  SwitchedState x;
  PhaseFlow flow;
  Edges edges;
  for (int k = 0; k < 3; ++k)
    advance_period(d, x, block_command(0, 1, 0.008, PwmMode::kComplementary), {.bus_voltage_V = 24.0}, 0.5,
                   flow, &edges);
  for (const auto& e : edges.leg0) EXPECT_NE(e.second, LegState::kHigh);
  EXPECT_EQ(flow.square_A2_s, 0.0);
}

TEST(SwitchedDrive, DeadTimeTakesWhatTheFormulaSays) {
  // at standstill, current far above the ripple: R i = d V - f t_d (V + 2 V_f)
  const SwitchedDrive d = make_switched_drive(trapezoid_motor(), kReal, {.extra_inertia_kg_m2 = 1e3});
  SwitchedState x;
  PhaseFlow flow;
  const BridgeCommand c = block_command(0, 1, 0.4, PwmMode::kComplementary);
  for (int k = 0; k < 400; ++k) advance_period(d, x, c, {.bus_voltage_V = 24.0}, 0.5, flow);
  PhaseFlow mean;
  for (int k = 0; k < 20; ++k) advance_period(d, x, c, {.bus_voltage_V = 24.0}, 0.5, mean);
  const double volt = (0.447 + 0.024) * mean.charge_C[0] / mean.time_s;
  // during the gaps the diode conducts behind the same R_on, so the formula is exact but for the slope
  EXPECT_NEAR(volt, 0.4 * 24.0 - dead_time_loss_V(kReal, 24.0), 1e-6);
}

TEST(SwitchedDrive, SampleIsTheCurrentOfItsInstant) {
  const SwitchedDrive d = make_switched_drive(trapezoid_motor(), kIdeal, {.extra_inertia_kg_m2 = 1e3});
  SwitchedState x;
  PhaseFlow flow;
  const BridgeCommand c = block_command(0, 1, 0.5, PwmMode::kComplementary);
  for (int k = 0; k < 400; ++k) advance_period(d, x, c, {.bus_voltage_V = 24.0}, 0.5, flow);
  SwitchedState a = x, b = x, e = x;
  const double low = advance_period(d, a, c, {.bus_voltage_V = 24.0}, 0.0, flow).current_A[0];
  const double valley = advance_period(d, b, c, {.bus_voltage_V = 24.0}, 0.25, flow).current_A[0];
  const double peak = advance_period(d, e, c, {.bus_voltage_V = 24.0}, 0.75, flow).current_A[0];
  EXPECT_EQ(low, x.motor.current_A[0]);
  // swing of a half period on: (V - V d) d T / L
  EXPECT_NEAR(peak - valley, 12.0 * 25e-6 / 0.243e-3, 0.01);
  EXPECT_NEAR(a.motor.current_A[0], b.motor.current_A[0], 1e-12);  // where one samples changes nothing
}

TEST(SwitchedDrive, SameRunTwiceIsTheSameBitForBit) {
  EXPECT_EQ(energy_gap_ratio(kMotors[0], kReal, PwmMode::kHighSideChop, 5e-6),
            energy_gap_ratio(kMotors[0], kReal, PwmMode::kHighSideChop, 5e-6));
}

}  // namespace
}  // namespace omnihil
