#include "firmware_iface/reference/wheel_tuning.h"

#include <math.h>

static const float kTwoPi = 6.28318531f;
static const float kMassGuess_kg = 2.5f;               /* guess, robots of the league: 2.0 to 3.0 kg */
static const float kRotorInertiaGuess_kg_m2 = 1.0e-5f; /* guess, 30 to 70 W flat motors: 0.5e-5 to 1.8e-5 */
static const float kWheelInertiaGuess_kg_m2 = 1.0e-5f; /* guess, 50 to 60 mm omni wheel: 0.5e-5 to 3e-5 */
static const float kBandwidthLoaded_rad_s = 40.0f;
static const float kBandwidthTimesDelay = 0.8f; /* leaves 44 degrees of phase */
static const float kWindingDelay_s = 0.3e-3f;   /* L/R, guess: 0.1 to 0.6 ms */
static const float kRimSpeedStep_m_s = 0.02f;   /* what one count may look like */
static const float kReportFilter_s = 5.0e-3f;

void wheel_tuning_init(wheel_tuning* tuning, const omnihil_robot_config* config, float period_s) {
  float k = (float)config->motor_torque_constant_Nm_per_A;
  float resistance_ohm = (float)config->motor_resistance_ohm;
  float gear = (float)config->gear_ratio;
  float radius_m = (float)config->wheel_radius_m;
  float center_m = (float)config->wheel_center_radius_m;
  tuning->motor.torque_constant_Nm_per_A = k;
  tuning->motor.resistance_ohm = resistance_ohm;
  tuning->gear_ratio = gear;
  tuning->mass_kg = kMassGuess_kg;
  /* a solid disc of the wheels' radius */
  tuning->yaw_inertia_kg_m2 = 0.5f * kMassGuess_kg * center_m * center_m;
  tuning->inertia_free_kg_m2 = kRotorInertiaGuess_kg_m2 + kWheelInertiaGuess_kg_m2 / (gear * gear);
  /* m v^2 = J sum(omega_i^2) and sum(omega_i^2) = 2 (gear v / r)^2 on average over directions */
  float inertia_loaded_kg_m2 =
      tuning->inertia_free_kg_m2 + kMassGuess_kg * radius_m * radius_m / (2.0f * gear * gear);

  encoder_setup* encoder = &tuning->encoder;
  /* the one place where the counter's direction goes in */
  encoder->rad_per_count = kTwoPi / (float)config->encoder_counts_per_rotor_turn;
  float step_rad_s = fabsf(encoder->rad_per_count) / period_s;
  float step_wanted_rad_s = kRimSpeedStep_m_s * gear / radius_m;
  encoder->filter_s = period_s * fmaxf(0.0f, step_rad_s / step_wanted_rad_s - 1.0f);
  encoder->report_filter_s = fmaxf(kReportFilter_s, encoder->filter_s);
  /* no motor on this bus turns three times as fast as its no-load speed; leave room for a count or two */
  encoder->omega_rotor_max_rad_s = 3.0f * (float)config->bus_voltage_nominal_V / k + 4.0f * step_rad_s;

  /* half a period of hold, half of differencing */
  float delay_s = period_s + encoder->filter_s + kWindingDelay_s;
  float p_loaded = kBandwidthLoaded_rad_s * inertia_loaded_kg_m2 * resistance_ohm / k - k;
  float p_free = kBandwidthTimesDelay / delay_s * tuning->inertia_free_kg_m2 * resistance_ohm / k - k;
  tuning->gains.p_V_s_per_rad = fmaxf(0.0f, fminf(p_loaded, p_free));
  float stiffness = tuning->gains.p_V_s_per_rad + k;
  float bandwidth_rad_s = stiffness * k / (inertia_loaded_kg_m2 * resistance_ohm);
  tuning->gains.i_V_per_rad = stiffness * bandwidth_rad_s / 4.0f;
  tuning->gains.d_V_s2_per_rad = 0.0f;
}
