#include "firmware_iface/reference/foc_controller.h"

#include <math.h>

#define ONE_OVER_ROOT3 0.577350269f

static float clamp(float value, float limit) { return fmaxf(-limit, fminf(limit, value)); }

void foc_tune(foc_gains* gains, const foc_motor* motor, float current_bandwidth_rad_s,
              float speed_bandwidth_rad_s, float current_limit_A) {
  float torque_per_A = 1.5f * (float)motor->pole_pairs * motor->flux_linkage_Wb;
  gains->d_p_V_per_A = motor->inductance_d_H * current_bandwidth_rad_s;
  gains->q_p_V_per_A = motor->inductance_q_H * current_bandwidth_rad_s;
  gains->current_i_V_per_A_s = motor->resistance_ohm * current_bandwidth_rad_s;
  gains->speed_p_A_s_per_rad = motor->inertia_kg_m2 * speed_bandwidth_rad_s / torque_per_A;
  gains->speed_i_A_per_rad = 0.25f * gains->speed_p_A_s_per_rad * speed_bandwidth_rad_s;
  gains->current_limit_A = current_limit_A;
}

void foc_reset(foc_state* state) {
  state->integral_d_V = 0.0f;
  state->integral_q_V = 0.0f;
  state->integral_speed_A = 0.0f;
}

static float speed_loop(foc_state* state, const foc_gains* gains, const foc_input* input) {
  float error_rad_s = input->omega_ref_rad_s - input->omega_rotor_rad_s;
  float integral_A = clamp(state->integral_speed_A + gains->speed_i_A_per_rad * error_rad_s * input->dt_s,
                           gains->current_limit_A);
  float wanted_A = gains->speed_p_A_s_per_rad * error_rad_s + integral_A;
  float given_A = clamp(wanted_A, gains->current_limit_A);
  int deeper = (wanted_A - given_A) * (integral_A - state->integral_speed_A) > 0.0f;
  if (!deeper) state->integral_speed_A = integral_A;
  return given_A;
}

/* One axis: PI around a feed-forward, within +- limit. */
static float current_loop(float* integral_V, float p_V_per_A, float i_V_per_A_s, float error_A,
                          float forward_V, float limit_V, float dt_s, int* saturated) {
  float integral = *integral_V + i_V_per_A_s * error_A * dt_s;
  float wanted_V = p_V_per_A * error_A + integral + forward_V;
  float given_V = clamp(wanted_V, limit_V);
  if (given_V != wanted_V) *saturated = 1;
  int deeper = (wanted_V - given_V) * (integral - *integral_V) > 0.0f;
  if (!deeper) *integral_V = integral;
  return given_V;
}

void foc_update(foc_state* state, const foc_motor* motor, const foc_gains* gains, const foc_input* input,
                foc_output* output) {
  float omega_elec_rad_s = (float)motor->pole_pairs * input->omega_rotor_rad_s;
  foc_dq i = foc_park(foc_clarke(input->current_A[0], input->current_A[1], input->current_A[2]),
                      sinf(input->theta_elec_rad), cosf(input->theta_elec_rad));
  float i_q_ref_A = input->mode == FOC_SPEED ? speed_loop(state, gains, input)
                                             : clamp(input->i_q_ref_A, gains->current_limit_A);
  float limit_V = input->bus_V * ONE_OVER_ROOT3;
  output->saturated = 0;
  foc_dq v;
  v.d =
      current_loop(&state->integral_d_V, gains->d_p_V_per_A, gains->current_i_V_per_A_s, -i.d,
                   -omega_elec_rad_s * motor->inductance_q_H * i.q, limit_V, input->dt_s, &output->saturated);
  float left_V = sqrtf(fmaxf(0.0f, limit_V * limit_V - v.d * v.d));
  v.q = current_loop(&state->integral_q_V, gains->q_p_V_per_A, gains->current_i_V_per_A_s, i_q_ref_A - i.q,
                     omega_elec_rad_s * (motor->inductance_d_H * i.d + motor->flux_linkage_Wb), left_V,
                     input->dt_s, &output->saturated);
  float ahead_rad = input->theta_elec_rad + omega_elec_rad_s * input->delay_s;
  foc_duties(foc_inverse_park(v, sinf(ahead_rad), cosf(ahead_rad)), input->bus_V, output->duty_ratio);
  output->i_d_A = i.d;
  output->i_q_A = i.q;
  output->v_d_V = v.d;
  output->v_q_V = v.q;
  output->i_q_ref_A = i_q_ref_A;
}
