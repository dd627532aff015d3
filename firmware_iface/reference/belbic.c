#include "firmware_iface/reference/belbic.h"

const belbic_rates kBelbicRates = {40.0f, 400.0f};

static const float kMost = 20.0f;         /* of a weight: twenty times the PI's own gain */
static const float kIntegralShare = 0.5f; /* of the supply, as in wheel_controller.c */

static float clamp(float value, float least, float most) {
  return value > most ? most : value < least ? least : value;
}

void belbic_reset(belbic_loop* loop) {
  loop->amygdala = 1.0f; /* the PI's own answer to an error */
  loop->orbitofrontal = 0.0f;
  loop->integral_rad = 0.0f;
  loop->duty_ratio = 0.0f;
}

float belbic_update(belbic_loop* loop, const belbic_rates* rates, const wheel_gains* gains,
                    const motor_constants* motor, const wheel_loop_input* input) {
  float k = motor->torque_constant_Nm_per_A;
  float error_rad_s = input->omega_ref_rad_s - input->omega_rad_s;
  float feedforward =
      (k * input->omega_ref_rad_s + motor->resistance_ohm / k * input->torque_feedforward_Nm) / input->bus_V;

  float per_rad = gains->i_V_per_rad / input->bus_V;
  float integral_rad = loop->integral_rad + error_rad_s * input->dt_s;
  if (per_rad > 0.0f) integral_rad = clamp(integral_rad, -kIntegralShare / per_rad, kIntegralShare / per_rad);
  float stimulus = gains->p_V_s_per_rad * error_rad_s / input->bus_V;
  float emotion = stimulus + per_rad * integral_rad;

  float amygdala = loop->amygdala * stimulus;
  float answer = amygdala - loop->orbitofrontal * stimulus;
  float wanted = feedforward + answer;
  loop->duty_ratio = clamp(wanted, -1.0f, 1.0f);
  /* at the limit: what leads deeper is neither summed nor learned */
  int deeper = (wanted - loop->duty_ratio) * error_rad_s > 0.0f;
  if (deeper) return loop->duty_ratio;
  loop->integral_rad = integral_rad;
  float learned = stimulus * (emotion - amygdala);
  if (learned > 0.0f)
    loop->amygdala = clamp(loop->amygdala + rates->amygdala_per_s * learned * input->dt_s, 0.0f, kMost);
  loop->orbitofrontal =
      clamp(loop->orbitofrontal + rates->orbitofrontal_per_s * stimulus * (answer - emotion) * input->dt_s,
            -kMost, kMost);
  return loop->duty_ratio;
}
