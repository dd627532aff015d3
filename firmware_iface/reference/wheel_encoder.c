#include "firmware_iface/reference/wheel_encoder.h"

#include <math.h>

enum { JUMPS_THAT_ARE_A_FAULT = 5 };

void wheel_encoder_update(wheel_encoder* encoder, const encoder_setup* setup, int64_t counts, float dt_s) {
  /* unsigned difference: right across the wrap of the counter */
  int64_t delta = (int64_t)((uint64_t)counts - (uint64_t)encoder->counts);
  encoder->counts = counts;
  if (!encoder->primed) {
    encoder->primed = 1;
    return;
  }
  /* more than 32 bits is no rotation; the rest is narrowed, as 64 bits to float is a long calculation on a
   * small core */
  float raw_rad_s = (float)(int32_t)delta * setup->rad_per_count / dt_s;
  if (delta != (int32_t)delta || fabsf(raw_rad_s) > setup->omega_rotor_max_rad_s) {
    ++encoder->jumps;
    ++encoder->jumps_now;
    return;
  }
  encoder->jumps_now = 0;
  float before_rad_s = encoder->omega_rotor_reported_rad_s;
  /* first-order low-pass, y += dt / (tau + dt) (x - y) */
  encoder->omega_rotor_rad_s += dt_s / (setup->filter_s + dt_s) * (raw_rad_s - encoder->omega_rotor_rad_s);
  float share = dt_s / (setup->report_filter_s + dt_s);
  encoder->omega_rotor_reported_rad_s += share * (raw_rad_s - encoder->omega_rotor_reported_rad_s);
  float slope_rad_s2 = (encoder->omega_rotor_reported_rad_s - before_rad_s) / dt_s;
  encoder->accel_rotor_rad_s2 += share * (slope_rad_s2 - encoder->accel_rotor_rad_s2);
}

int wheel_encoder_faulty(const wheel_encoder* encoder) {
  return encoder->jumps_now >= JUMPS_THAT_ARE_A_FAULT;
}
