/* The reference's speed loop with an integrator that nothing stops: it takes the place of wheel_controller.c.
 */
#include <math.h>

#include "firmware_iface/reference/wheel_controller.h"
#include "tests/hil/scenario/firmware/wrapped.h"

static float clamp(float value, float limit) { return fmaxf(-limit, fminf(limit, value)); }

float wheel_loop_update(wheel_loop* loop, const wheel_gains* gains, const motor_constants* motor,
                        const wheel_loop_input* input) {
  float k = motor->torque_constant_Nm_per_A;
  float error_rad_s = input->omega_ref_rad_s - input->omega_rad_s;
  float feedforward_V = k * input->omega_ref_rad_s + motor->resistance_ohm / k * input->torque_feedforward_Nm;
  loop->integral_V += gains->i_V_per_rad * error_rad_s * input->dt_s;
  float wanted_V = feedforward_V + gains->p_V_s_per_rad * error_rad_s -
                   gains->d_V_s2_per_rad * input->accel_rad_s2 + loop->integral_V;
  loop->duty_ratio = clamp(wanted_V / input->bus_V, 1.0f);
  return loop->duty_ratio;
}

void wheel_loop_reset(wheel_loop* loop) {
  loop->integral_V = 0.0f;
  loop->duty_ratio = 0.0f;
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static omnihil_firmware_api api;
  api = *reference();
  api.name = "integrator without limit";
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
