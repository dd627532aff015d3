// Terminal voltages of a bridge's legs: driven ones by the bridge, floating ones by the windings.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sim/drive/phase_bench.h"

namespace omnihil {
namespace {

constexpr double kBus_V = 24.0, kDiode_V = 0.8, kOn_ohm = 0.012;
constexpr Inverter kBridge{
    .pwm_frequency_Hz = 20e3, .switch_resistance_ohm = kOn_ohm, .diode_forward_V = kDiode_V};

// The rotor turned from outside; means of one step, in whose middle it is at this angle.
struct Turned {
  Turned(const PhaseMotor<double>& motor, double omega_rad_s, double step_s = 1e-9)
      : circuit(make_phase_circuit(motor, kOn_ohm, step_s, 0.0)), omega_rotor_rad_s(omega_rad_s) {}

  std::array<double, 3> at(double theta_elec_rad, std::array<LegState, 3> legs = {}) {
    x.omega_rotor_rad_s = omega_rotor_rad_s;
    x.theta_rotor_rad = theta_elec_rad / circuit.pole_pairs - 0.5 * omega_rotor_rad_s * circuit.step.h_s;
    flow = {};
    std::array<Leg, 3> leg;
    for (std::size_t n = 0; n < 3; ++n) leg[n] = leg_of(kBridge, legs[n], kBus_V);
    advance_circuit(circuit, x, leg, {.bus_voltage_V = kBus_V, .speed_is_imposed = true}, circuit.step.h_s,
                    flow);
    std::array<double, 3> volts;
    for (std::size_t n = 0; n < 3; ++n) volts[n] = flow.leg_V_s[n] / flow.time_s;
    return volts;
  }
  // e_x = -p lambda omega sin(theta - x)
  double emf_V(double theta_elec_rad, int phase) const {
    return -circuit.back_emf_V_s_per_rad * omega_rotor_rad_s *
           std::sin(theta_elec_rad - phase * 120.0 * kDegree);
  }

  PhaseCircuit circuit;
  double omega_rotor_rad_s;
  PhaseState x;
  PhaseFlow flow;
};

// Line to line the peak is sqrt(3) p lambda omega, the torque constant of a sinusoidal drive times omega; phase a leads b leads
// c forwards.
TEST(LegVoltage, OfAnOpenMotorThatIsTurnedIsItsBackEmfLineToLine) {
  for (const double omega_rad_s : {300.0, -300.0}) {
    Turned motor(sine_motor(), omega_rad_s);
    double most_V = 0.0;
    for (int degree = 0; degree < 360; ++degree) {
      const double theta = degree * kDegree;
      const auto volts = motor.at(theta);
      for (int n = 0; n < 3; ++n) {
        const int next = (n + 1) % 3;
        const double apart_V = volts[static_cast<std::size_t>(n)] - volts[static_cast<std::size_t>(next)];
        EXPECT_NEAR(apart_V, motor.emf_V(theta, n) - motor.emf_V(theta, next), 1e-9);
      }
      most_V = std::max(most_V, std::abs(volts[0] - volts[1]));
    }
    const double peak_V = std::sqrt(3.0) * motor.circuit.back_emf_V_s_per_rad * 300.0;
    EXPECT_NEAR(most_V, peak_V, 1e-3 * peak_V);
    EXPECT_EQ(motor.flow.square_A2_s, 0.0);
  }
}

// Its mean is half of the bus until a phase's peak passes that and a diode: then the phase at its rail moves the others.
TEST(LegVoltage, OfAnOpenMotorStaysWithinTheDiodes) {
  const PhaseMotor<double> motor = sine_motor();
  const double per_omega_V = make_phase_circuit(motor, kOn_ohm, 1e-6, 0.0).back_emf_V_s_per_rad;
  const double most_V = 0.5 * kBus_V + kDiode_V;  // of a phase about its mean
  int held = 0;
  for (int degree = 0; degree < 360; ++degree) {
    const auto slow = Turned(motor, 0.99 * most_V / per_omega_V).at(degree * kDegree);
    EXPECT_NEAR(slow[0] + slow[1] + slow[2], 1.5 * kBus_V, 1e-9);
    // past that, before a pair rectifies at 2 / sqrt(3) of it
    const auto fast = Turned(motor, 1.15 * most_V / per_omega_V).at(degree * kDegree);
    const double highest_V = std::max({fast[0], fast[1], fast[2]}),
                 lowest_V = std::min({fast[0], fast[1], fast[2]});
    EXPECT_LE(highest_V, kBus_V + kDiode_V + 1e-9);
    EXPECT_GE(lowest_V, -kDiode_V - 1e-9);
    held += std::abs(fast[0] + fast[1] + fast[2] - 1.5 * kBus_V) > 0.1;
  }
  EXPECT_GT(held, 60);
}

TEST(LegVoltage, OfAThirdLegIsTheMiddleOfTheOtherTwoAndItsBackEmf) {
  Turned motor(sine_motor(), 200.0);
  for (int degree = 0; degree < 360; degree += 7) {
    motor.x.current_A = {};
    const double theta = degree * kDegree;
    const auto volts = motor.at(theta, {LegState::kHigh, LegState::kLow, LegState::kOff});
    // star = bus / 2 - (e_a + e_b) / 2;  three sines sum to zero
    EXPECT_NEAR(volts[2], 0.5 * kBus_V + 1.5 * motor.emf_V(theta, 2), 1e-9);
  }
}

TEST(LegVoltage, OfALegThatCarriesCurrentThroughADiodeIsThatRail) {
  const PhaseMotor<double> motor = sine_motor();
  Turned still(motor, 0.0, 1e-7);
  still.x.current_A = {4.0, -4.0, 0.0};
  const auto volts = still.at(0.0);
  EXPECT_NEAR(volts[0], -kDiode_V - kOn_ohm * 4.0, 1e-3);
  EXPECT_NEAR(volts[1], kBus_V + kDiode_V + kOn_ohm * 4.0, 1e-3);
  EXPECT_NEAR(volts[2], 0.5 * kBus_V, 1e-9);
}

// Turned faster than the bus, it rectifies: the two outer phases are at the rails, the third between them.
TEST(LegVoltage, OfAMotorTurnedPastTheBusStaysWithinTheDiodes) {
  const PhaseMotor<double> motor = sine_motor();
  const double per_omega_V =
      std::sqrt(3.0) * make_phase_circuit(motor, kOn_ohm, 1e-6, 0.0).back_emf_V_s_per_rad;
  const double step_s = 1e-6;
  Turned fast(motor, 1.3 * kBus_V / per_omega_V, step_s);
  double theta = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const auto volts = fast.at(theta);
    const auto& i = fast.x.current_A;
    const double drop_V = kOn_ohm * std::max({std::abs(i[0]), std::abs(i[1]), std::abs(i[2])}) + 1e-3;
    for (const double v : volts) {
      EXPECT_GE(v, -kDiode_V - drop_V);
      EXPECT_LE(v, kBus_V + kDiode_V + drop_V);
    }
    theta += fast.circuit.pole_pairs * fast.omega_rotor_rad_s * step_s;
  }
}

// Three complementary legs: what the bridge gives, less what its switches and its dead time take.
TEST(LegVoltage, OfADrivenLegIsItsDutysShareOfTheBus) {
  Inverter bridge = kBridge;
  bridge.dead_time_s = 0.5e-6;
  const SwitchedDrive drive = make_switched_drive(sine_motor(), bridge, {.extra_inertia_kg_m2 = 1e3});
  const BridgeCommand legs = sine_command({0.55, 0.45, 0.5});
  SwitchedState x;
  PhaseFlow flow;
  for (int n = 0; n < 100; ++n) {  // the current settles
    flow = {};
    advance_period(drive, x, legs, {.bus_voltage_V = kBus_V, .speed_is_imposed = true}, 0.5, flow);
  }
  const double loss_V = dead_time_loss_V(bridge, kBus_V), mean_A = flow.charge_C[0] / flow.time_s;
  EXPECT_GT(mean_A, 2.0);
  EXPECT_NEAR(flow.leg_V_s[0] / flow.time_s, 0.55 * kBus_V - loss_V - kOn_ohm * mean_A, 1e-3);
  EXPECT_NEAR(flow.leg_V_s[1] / flow.time_s, 0.45 * kBus_V + loss_V + kOn_ohm * mean_A, 1e-3);
}

}  // namespace
}  // namespace omnihil
