#include "firmware_iface/reference/wheel_controller.h"

static const float kIntegralShare = 0.5f;

/* By comparisons, which a core without a maximum instruction does in two; fmaxf() is a call there. */
static float clamp(float value, float limit) {
  return value > limit ? limit : value < -limit ? -limit : value;
}

float wheel_loop_update(wheel_loop* loop, const wheel_gains* gains, const motor_constants* motor,
                        const wheel_loop_input* input) {
  float k = motor->torque_constant_Nm_per_A;
  float error_rad_s = input->omega_ref_rad_s - input->omega_rad_s;
  /* u = k omega_ref + (R / k) tau_ff */
  float feedforward_V = k * input->omega_ref_rad_s + motor->resistance_ohm / k * input->torque_feedforward_Nm;
  float rest_V =
      feedforward_V + gains->p_V_s_per_rad * error_rad_s - gains->d_V_s2_per_rad * input->accel_rad_s2;

  float most_V = kIntegralShare * input->bus_V;
  float integral_V = clamp(loop->integral_V + gains->i_V_per_rad * error_rad_s * input->dt_s, most_V);
  float wanted_V = rest_V + integral_V;
  float given_V = clamp(wanted_V, input->bus_V);
  /* anti-windup: at the limit, keep the integral unless it leads away from the limit */
  int deeper = (wanted_V - given_V) * (integral_V - loop->integral_V) > 0.0f;
  if (!deeper) loop->integral_V = integral_V;
  loop->duty_ratio = clamp(given_V / input->bus_V, 1.0f);
  return loop->duty_ratio;
}

void wheel_loop_reset(wheel_loop* loop) {
  loop->integral_V = 0.0f;
  loop->duty_ratio = 0.0f;
}
