// The reference FOC closes its loops on the switched bridge and motor, through encoder or Hall sensors and
// ADC.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "firmware_iface/reference/foc_controller.h"
#include "firmware_iface/reference/foc_hall_angle.h"
#include "sim/drive/absolute_encoder.h"
#include "sim/drive/current_sensor.h"
#include "tests/sim/drive/phase_bench.h"

namespace omnihil {
namespace {

constexpr double kPeriod_s = 50e-6, kBus_V = 24.0;
constexpr Inverter kBridge{
    .pwm_frequency_Hz = 20e3, .dead_time_s = 0.3e-6, .switch_resistance_ohm = 0.012, .diode_forward_V = 0.8};
constexpr AbsoluteEncoderParams kEncoder{.bits = 14};
constexpr CurrentSensor kSensor{.shunt_ohm = 2e-3, .amplifier_gain = 20.0, .noise_sigma_V = 1e-3};

foc_motor firmware_motor(const PhaseMotor<double>& m) {
  return {static_cast<float>(m.resistance_ohm),      static_cast<float>(m.inductance_d_H),
          static_cast<float>(m.inductance_q_H),      static_cast<float>(m.flux_linkage_Wb),
          static_cast<float>(m.rotor_inertia_kg_m2), m.pole_pairs};
}

// Plant, sensors and firmware together. What is sampled in one period acts in the next.
struct Loop {
  PhaseMotor<double> motor;
  SwitchedDrive drive;
  SwitchedState x;
  PhaseFlow flow;
  foc_motor known{};
  foc_gains gains{};
  foc_state state{};
  foc_output out{};
  six_step_hall hall_seen{};
  HallParams hall;
  bool by_hall = false;
  double angle_error_rad = 0.0;  // electrical, between what the firmware takes for the d axis and the d axis
  double tau_load_Nm = 0.0;
  bool speed_is_imposed = false;
  double previous_angle_rad = 0.0, omega_seen_rad_s = 0.0;
  std::uint64_t sample = 0;

  explicit Loop(const PhaseMotor<double>& m)
      : motor(m), drive(make_switched_drive(m, kBridge, {})), known(firmware_motor(m)) {
    foc_tune(&gains, &known, 2.0f * 3.14159265f * 1000.0f, 2.0f * 3.14159265f * 25.0f, 8.0f);
    foc_reset(&state);
    six_step_hall_reset(&hall_seen);
    for (float& d : out.duty_ratio) d = 0.5f;
  }

  // Angle and speed as the firmware has them, from the codes of its sensor alone.
  void sense(const PeriodSample& s, foc_input& in) {
    if (by_hall) {
      six_step_hall_update(&hall_seen, hall_code(hall, 8 * s.theta_rotor_rad), static_cast<float>(kPeriod_s));
      in.theta_elec_rad = foc_hall_angle_rad(&hall_seen);
      in.omega_rotor_rad_s = six_step_hall_omega_elec_rad_s(&hall_seen) / 8.0f;
      return;
    }
    const double angle = absolute_encoder_rad(
        kEncoder, absolute_encoder_code(kEncoder, s.theta_rotor_rad, s.omega_rotor_rad_s));
    const double turned = std::remainder(angle - previous_angle_rad, 2.0 * std::numbers::pi);
    previous_angle_rad = angle;
    omega_seen_rad_s += 0.1 * (turned / kPeriod_s - omega_seen_rad_s);
    in.theta_elec_rad = static_cast<float>(std::fmod(8.0 * angle + angle_error_rad, 2.0 * std::numbers::pi));
    in.omega_rotor_rad_s = static_cast<float>(omega_seen_rad_s);
  }

  void period(foc_mode mode, double reference) {
    const std::array<double, 3> duty = {out.duty_ratio[0], out.duty_ratio[1], out.duty_ratio[2]};
    const PeriodSample s = advance_period(
        drive, x, sine_command(duty),
        {.bus_voltage_V = kBus_V, .tau_load_Nm = tau_load_Nm, .speed_is_imposed = speed_is_imposed}, 0.0,
        flow);
    foc_input in{};
    in.mode = mode;
    for (std::size_t p = 0; p < 3; ++p)
      in.current_A[p] = static_cast<float>(
          current_of_counts(kSensor, adc_counts(kSensor, shunt_current_A(kSensor, s, p), {1, p, sample})));
    ++sample;
    sense(s, in);
    in.i_q_ref_A = in.omega_ref_rad_s = static_cast<float>(reference);
    in.bus_V = static_cast<float>(kBus_V);
    in.dt_s = static_cast<float>(kPeriod_s);
    in.delay_s = static_cast<float>(1.5 * kPeriod_s);
    foc_update(&state, &known, &gains, &in, &out);
  }

  // d and q currents as they are.
  foc_dq true_current() const {
    const double theta = 8 * x.motor.theta_rotor_rad;
    const auto& i = x.motor.current_A;
    return foc_park(foc_clarke(static_cast<float>(i[0]), static_cast<float>(i[1]), static_cast<float>(i[2])),
                    static_cast<float>(std::sin(theta)), static_cast<float>(std::cos(theta)));
  }
};

TEST(Foc, TransformsKeepAmplitudeAndUndoEachOther) {
  for (float theta = 0.0f; theta < 6.28f; theta += 0.37f) {
    const float s = std::sin(theta), c = std::cos(theta);
    // currents of amplitude 3 along q
    const auto phase = [&](float lag) { return -3.0f * std::sin(theta - lag); };
    const foc_dq i = foc_park(foc_clarke(phase(0.0f), phase(2.0943951f), phase(4.1887902f)), s, c);
    EXPECT_NEAR(i.d, 0.0f, 2e-6f);
    EXPECT_NEAR(i.q, 3.0f, 2e-6f);
    const foc_dq back = foc_park(foc_inverse_park(i, s, c), s, c);
    EXPECT_NEAR(back.q, i.q, 1e-6f);
  }
}

TEST(Foc, DutiesGiveTheAskedVoltageUpToBusOverRootThree) {
  for (float theta = 0.0f; theta < 6.28f; theta += 0.1f) {
    const float length = 24.0f / std::sqrt(3.0f) * 0.999f;
    const foc_alpha_beta v = {length * std::cos(theta), length * std::sin(theta)};
    float d[3];
    foc_duties(v, 24.0f, d);
    const foc_alpha_beta got = foc_clarke(24.0f * d[0], 24.0f * d[1], 24.0f * d[2]);
    EXPECT_NEAR(got.alpha, v.alpha, 2e-5f);
    EXPECT_NEAR(got.beta, v.beta, 2e-5f);
    for (const float x : d) EXPECT_TRUE(x >= 0.0f && x <= 1.0f);
  }
}

TEST(Foc, SpeedStepIsReachedWithoutMuchOvershootAndHeldUnderLoad) {
  Loop loop(sine_motor());
  double highest = 0.0, largest_i_d = 0.0;
  for (int k = 0; k < 4000; ++k) {
    loop.period(FOC_SPEED, 200.0);
    highest = std::max(highest, loop.x.motor.omega_rotor_rad_s);
    largest_i_d = std::max(largest_i_d, std::abs(static_cast<double>(loop.true_current().d)));
  }
  EXPECT_NEAR(loop.x.motor.omega_rotor_rad_s, 200.0, 1.0);
  EXPECT_LT(highest, 230.0);
  EXPECT_LT(largest_i_d, 2.5);
  loop.tau_load_Nm = 0.05;
  for (int k = 0; k < 4000; ++k) loop.period(FOC_SPEED, 200.0);
  EXPECT_NEAR(loop.x.motor.omega_rotor_rad_s, 200.0, 1.0);
  // 3/2 p lambda i_q carries load and friction
  const double i_q = (0.05 + 200.0 * 2e-5) / (1.5 * 8 * loop.motor.flux_linkage_Wb);
  EXPECT_NEAR(loop.true_current().q, i_q, 0.1 * i_q + 0.2);
  for (int k = 0; k < 6000; ++k) loop.period(FOC_SPEED, -300.0);
  EXPECT_NEAR(loop.x.motor.omega_rotor_rad_s, -300.0, 1.5);
}

TEST(Foc, CurrentStepSettlesAsFastAsItsBandwidthSays) {
  Loop loop(sine_motor());
  loop.speed_is_imposed = true;
  loop.x.motor.omega_rotor_rad_s = 100.0;
  for (int k = 0; k < 400; ++k) loop.period(FOC_CURRENT, 0.0);
  for (int k = 0; k < 40; ++k) loop.period(FOC_CURRENT, 5.0);  // 2 ms: twelve time constants
  double sum = 0.0, worst = 0.0;
  for (int k = 0; k < 400; ++k) {
    loop.period(FOC_CURRENT, 5.0);
    sum += loop.true_current().q / 400.0;
    worst = std::max(worst, std::abs(loop.true_current().q - 5.0));
  }
  EXPECT_NEAR(sum, 5.0, 0.05);
  EXPECT_LT(worst, 0.6);  // dead time, quantisation (40 mA) and noise
}

TEST(Foc, WrongAngleCostsTheCosineInTorque) {
  const auto torque = [](double error_deg) {
    Loop loop(sine_motor());
    loop.speed_is_imposed = true;
    loop.x.motor.omega_rotor_rad_s = 60.0;
    loop.angle_error_rad = error_deg * kDegree;
    for (int k = 0; k < 400; ++k) loop.period(FOC_CURRENT, 5.0);
    loop.flow = {};
    for (int k = 0; k < 2094; ++k) loop.period(FOC_CURRENT, 5.0);  // a rotor turn
    return loop.flow.impulse_Nm_s / loop.flow.time_s;
  };
  const double right = torque(0.0);
  EXPECT_NEAR(right, 1.5 * 8 * sine_motor().flux_linkage_Wb * 5.0, 0.02 * right);
  for (const double error : {-30.0, 10.0, 30.0})
    EXPECT_NEAR(torque(error) / right, std::cos(error * kDegree), 0.01) << error;
}

TEST(Foc, RunsOnHallSensorsAlone) {
  Loop loop(sine_motor());
  loop.by_hall = true;
  foc_tune(&loop.gains, &loop.known, 2.0f * 3.14159265f * 800.0f, 2.0f * 3.14159265f * 6.0f, 5.0f);
  double lowest = 1e9, highest = 0.0;
  for (int k = 0; k < 16000; ++k) {
    loop.period(FOC_SPEED, 200.0);
    if (k < 12000) continue;
    lowest = std::min(lowest, loop.x.motor.omega_rotor_rad_s);
    highest = std::max(highest, loop.x.motor.omega_rotor_rad_s);
  }
  EXPECT_GT(lowest, 190.0);
  EXPECT_LT(highest, 210.0);
}

TEST(Foc, VoltageLimitDoesNotWindUp) {
  Loop loop(sine_motor());
  for (int k = 0; k < 6000; ++k) loop.period(FOC_SPEED, 2000.0);  // far beyond what the bus allows
  EXPECT_EQ(loop.out.saturated, 1);
  EXPECT_GT(loop.x.motor.omega_rotor_rad_s, 600.0);
  int periods = 0;
  while (std::abs(loop.x.motor.omega_rotor_rad_s - 200.0) > 5.0 && periods < 6000) {
    loop.period(FOC_SPEED, 200.0);
    ++periods;
  }
  // at 8 A: J dw / tau = 135e-7 * 600 / (8 A) / k, some 35 ms
  EXPECT_LT(periods, 2000);
}

}  // namespace
}  // namespace omnihil
