// The reference six-step controller closes its loop on the switched bridge and motor, through Hall sensors.
#include <gtest/gtest.h>

#include <algorithm>

#include "firmware_iface/reference/foc_hall_angle.h"
#include "firmware_iface/reference/six_step_controller.h"
#include "tests/sim/drive/phase_bench.h"

namespace omnihil {
namespace {

constexpr double kPeriod_s = 50e-6, kBus_V = 24.0;
constexpr Inverter kBridge{
    .pwm_frequency_Hz = 20e3, .dead_time_s = 0.3e-6, .switch_resistance_ohm = 0.012, .diode_forward_V = 0.8};

BridgeCommand bridge_of(const six_step_output& out, PwmMode mode) {
  BridgeCommand c{};
  const LegState high_off = mode == PwmMode::kComplementary ? LegState::kLow : LegState::kOff;
  const LegState low_off = mode == PwmMode::kFastDecay ? LegState::kOff : LegState::kLow;
  for (std::size_t x = 0; x < 3; ++x) {
    if (out.leg[x] == SIX_STEP_LEG_PWM) c[x] = {LegState::kHigh, high_off, out.duty_ratio};
    if (out.leg[x] == SIX_STEP_LEG_LOW) c[x] = {LegState::kLow, low_off, out.duty_ratio};
  }
  return c;
}

struct Loop {
  SwitchedDrive drive;
  SwitchedState x;
  PhaseFlow flow;
  HallParams hall;
  six_step_settings settings{8, 0.0295f, 0.03f, 0.6f, 1.0f, 0};
  six_step_state state{};
  six_step_output out{};
  double tau_load_Nm = 0.0;
  bool speed_is_imposed = false;
  PwmMode mode = PwmMode::kComplementary;
  std::uint64_t sample = 0;

  explicit Loop(const PhaseMotor<double>& m) : drive(make_switched_drive(m, kBridge, {})) {
    six_step_reset(&state);
  }

  void period(six_step_mode asked, double reference) {
    const int code = hall_with_glitches(hall, hall_code(hall, 8 * x.motor.theta_rotor_rad), {7, 1, sample++});
    six_step_input in{};
    in.mode = asked;
    in.hall_code = code;
    in.duty_ratio = in.omega_ref_rad_s = static_cast<float>(reference);
    in.bus_V = static_cast<float>(kBus_V);
    in.dt_s = static_cast<float>(kPeriod_s);
    six_step_update(&state, &settings, &in, &out);
    advance_period(
        drive, x, bridge_of(out, mode),
        {.bus_voltage_V = kBus_V, .tau_load_Nm = tau_load_Nm, .speed_is_imposed = speed_is_imposed}, 0.5,
        flow);
  }
};

TEST(SixStep, EverySectorPushesForwardAndBackward) {
  for (int sector = 0; sector < 6; ++sector)
    for (const double duty : {0.1, -0.1}) {
      Loop loop(trapezoid_motor());
      loop.x.motor.theta_rotor_rad = 60.0 * sector * kDegree / 8;
      for (int k = 0; k < 5; ++k) loop.period(SIX_STEP_DUTY, duty);
      EXPECT_GT(loop.flow.impulse_Nm_s * (duty > 0 ? 1.0 : -1.0), 0.0) << sector;
    }
}

TEST(SixStep, SpeedStepIsReachedInEveryPwmModeAndDirection) {
  for (const PwmMode mode : {PwmMode::kComplementary, PwmMode::kHighSideChop, PwmMode::kFastDecay})
    for (const double wanted : {150.0, -300.0}) {
      Loop loop(trapezoid_motor());
      loop.mode = mode;
      loop.tau_load_Nm = wanted > 0 ? 0.02 : -0.02;
      for (int k = 0; k < 16000; ++k) loop.period(SIX_STEP_SPEED, wanted);
      EXPECT_NEAR(loop.x.motor.omega_rotor_rad_s, wanted, 0.02 * std::abs(wanted)) << static_cast<int>(mode);
      EXPECT_NEAR(loop.out.omega_rotor_rad_s, loop.x.motor.omega_rotor_rad_s, 0.02 * std::abs(wanted));
    }
}

TEST(SixStep, CurrentRippleIsThatOfPwmAndCommutation) {
  Loop loop(trapezoid_motor());
  loop.tau_load_Nm = 0.06;
  for (int k = 0; k < 12000; ++k) loop.period(SIX_STEP_SPEED, 200.0);
  double largest = 0.0;
  for (int k = 0; k < 1000; ++k) {
    loop.period(SIX_STEP_SPEED, 200.0);
    for (const double i : loop.x.motor.current_A) largest = std::max(largest, std::abs(i));
  }
  // mean by torque 0.064 / 0.0295 = 2.2 A; half of the PWM's ripple d (1 - d) V T / L = 1.1 A, commutation
  // the rest
  EXPECT_GT(largest, 1.8);
  EXPECT_LT(largest, 4.5);
}

TEST(SixStep, MountingErrorOfTheSensorsCostsTheCosineInTorquePerAmpere) {
  const auto torque_per_A = [](double error_deg) {
    Loop loop(sine_motor());
    loop.hall.mounting_error_rad = error_deg * kDegree;
    loop.speed_is_imposed = true;
    loop.x.motor.omega_rotor_rad_s = 3.0;  // slow: blocks of constant current
    double charge_C = 0.0;
    for (int k = 0; k < 41888; ++k) {  // a turn
      if (k == 1000) loop.flow = {};
      loop.period(SIX_STEP_DUTY, 0.1);
      double sum = 0.0;
      for (const double i : loop.x.motor.current_A) sum += std::abs(i);
      if (k >= 1000) charge_C += 0.5 * sum * kPeriod_s;
    }
    return loop.flow.impulse_Nm_s / charge_C;
  };
  const double right = torque_per_A(0.0);
  for (const double error : {-20.0, 10.0, 30.0})
    EXPECT_NEAR(torque_per_A(error) / right, std::cos(error * kDegree), 0.01) << error;
}

TEST(SixStep, UnevenSensorsDoNotShowInTheSpeed) {
  Loop loop(trapezoid_motor());
  loop.hall.sensor_offset_rad = {8 * kDegree, -5 * kDegree, 0.0};
  loop.speed_is_imposed = true;
  loop.x.motor.omega_rotor_rad_s = 50.0;
  double lowest = 1e9, highest = 0.0;
  for (int k = 0; k < 8000; ++k) {
    loop.period(SIX_STEP_DUTY, 0.1);
    if (k < 2000) continue;
    lowest = std::min(lowest, static_cast<double>(loop.out.omega_rotor_rad_s));
    highest = std::max(highest, static_cast<double>(loop.out.omega_rotor_rad_s));
  }
  EXPECT_NEAR(lowest, 50.0, 0.06 * 50.0);
  EXPECT_NEAR(highest, 50.0, 0.03 * 50.0);
}

TEST(SixStep, ZeroDutyBrakesOrCoasts) {
  for (const int coast : {0, 1}) {
    Loop loop(trapezoid_motor());
    loop.settings.coast_at_zero = coast;
    loop.x.motor.omega_rotor_rad_s = 200.0;
    for (int k = 0; k < 400; ++k) loop.period(SIX_STEP_DUTY, 0.0);
    // brake: time constant J R / k^2 = 7 ms; coast: friction alone, 0.7 s
    if (coast)
      EXPECT_GT(loop.x.motor.omega_rotor_rad_s, 190.0);
    else
      EXPECT_LT(loop.x.motor.omega_rotor_rad_s, 40.0);
  }
}

TEST(SixStep, BadCodesTurnTheBridgeOffAfterSixReads) {
  six_step_state state;
  six_step_reset(&state);
  const six_step_settings settings{8, 0.03f, 0.03f, 0.6f, 1.0f, 0};
  six_step_input in{};
  in.duty_ratio = 0.5f;
  in.bus_V = 24.0f;
  in.dt_s = 50e-6f;
  in.hall_code = 3;
  six_step_output out;
  six_step_update(&state, &settings, &in, &out);
  EXPECT_EQ(out.leg[1], SIX_STEP_LEG_PWM);
  EXPECT_EQ(out.leg[2], SIX_STEP_LEG_LOW);
  in.hall_code = 7;
  for (int k = 0; k < 5; ++k) six_step_update(&state, &settings, &in, &out);
  EXPECT_EQ(out.fault, 0);
  six_step_update(&state, &settings, &in, &out);
  EXPECT_EQ(out.fault, 1);
  for (const six_step_leg leg : out.leg) EXPECT_EQ(leg, SIX_STEP_LEG_OFF);
  in.hall_code = 2;
  six_step_update(&state, &settings, &in, &out);
  EXPECT_EQ(out.fault, 0);
}

TEST(SixStep, RareGlitchesAreSurvived) {
  Loop loop(trapezoid_motor());
  loop.hall.glitch_probability = 0.005;
  for (int k = 0; k < 16000; ++k) loop.period(SIX_STEP_SPEED, 150.0);
  EXPECT_GT(loop.x.motor.omega_rotor_rad_s, 100.0);
  EXPECT_GT(loop.state.hall.skipped, 0u);
}

TEST(SixStep, HallAngleFollowsTheRotorWithinATick) {
  six_step_hall seen;
  six_step_hall_reset(&seen);
  const double omega_elec = 1000.0;
  double worst = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const double theta = omega_elec * k * kPeriod_s;
    six_step_hall_update(&seen, hall_code({}, theta), static_cast<float>(kPeriod_s));
    if (k > 400)
      worst = std::max(worst, std::abs(std::remainder(static_cast<double>(foc_hall_angle_rad(&seen)) - theta,
                                                      2.0 * std::numbers::pi)));
  }
  EXPECT_LT(worst, 1.5 * omega_elec * kPeriod_s);
}

}  // namespace
}  // namespace omnihil
