#include "firmware_iface/reference/six_step_controller.h"

#include <math.h>

static float clamp(float value, float limit) { return fmaxf(-limit, fminf(limit, value)); }

void six_step_reset(six_step_state* state) {
  six_step_hall_reset(&state->hall);
  state->integral_V = 0.0f;
}

static float speed_loop(six_step_state* state, const six_step_settings* settings, const six_step_input* input,
                        float omega_rad_s) {
  float error_rad_s = input->omega_ref_rad_s - omega_rad_s;
  float limit_V = settings->duty_limit_ratio * input->bus_V;
  /* u = k omega_ref + p e + I */
  float rest_V =
      settings->back_emf_V_s_per_rad * input->omega_ref_rad_s + settings->p_V_s_per_rad * error_rad_s;
  float integral_V = clamp(state->integral_V + settings->i_V_per_rad * error_rad_s * input->dt_s, limit_V);
  float wanted_V = rest_V + integral_V;
  float given_V = clamp(wanted_V, limit_V);
  int deeper = (wanted_V - given_V) * (integral_V - state->integral_V) > 0.0f;
  if (!deeper) state->integral_V = integral_V;
  return given_V / input->bus_V;
}

static void set_legs(six_step_output* output, int sector, float duty_ratio) {
  static const signed char into[6] = {1, 1, 2, 2, 0, 0};
  static const signed char out_of[6] = {2, 0, 0, 1, 1, 2};
  int forward = duty_ratio > 0.0f;
  output->leg[forward ? into[sector] : out_of[sector]] = SIX_STEP_LEG_PWM;
  output->leg[forward ? out_of[sector] : into[sector]] = SIX_STEP_LEG_LOW;
  output->duty_ratio = fabsf(duty_ratio);
}

void six_step_update(six_step_state* state, const six_step_settings* settings, const six_step_input* input,
                     six_step_output* output) {
  six_step_hall_update(&state->hall, input->hall_code, input->dt_s);
  float omega_rad_s = six_step_hall_omega_elec_rad_s(&state->hall) / (float)settings->pole_pairs;
  output->omega_rotor_rad_s = omega_rad_s;
  output->duty_ratio = 0.0f;
  output->fault = six_step_hall_fault(&state->hall) || state->hall.sector < 0;
  for (int x = 0; x < 3; ++x) output->leg[x] = SIX_STEP_LEG_OFF;
  if (output->fault) {
    state->integral_V = 0.0f;
    return;
  }
  float duty_ratio =
      input->mode == SIX_STEP_SPEED ? speed_loop(state, settings, input, omega_rad_s) : input->duty_ratio;
  duty_ratio = clamp(duty_ratio, settings->duty_limit_ratio);
  if (fabsf(duty_ratio) > 0.0f) {
    set_legs(output, state->hall.sector, duty_ratio);
  } else if (!settings->coast_at_zero) {
    for (int x = 0; x < 3; ++x) output->leg[x] = SIX_STEP_LEG_LOW;
  }
}
