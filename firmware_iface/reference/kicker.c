#include "firmware_iface/reference/kicker.h"

#include <math.h>

#include "firmware_iface/omnihil_firmware.h"

static const float kChargeTime_s = 1.0f;
static const float kYawWindow_rad = 0.035f;
static const float kPulsePerSpeed_s2_per_m = 1.0e-3f;

void kicker_arm(kicker* k, uint32_t kind, uint32_t moment, float pulse_s, uint64_t until_us) {
  k->kind = kind;
  k->moment = moment;
  k->pulse_s = pulse_s;
  k->armed_until_us = until_us;
}

void kicker_disarm(kicker* k) { k->kind = OMNIHIL_KICK_NONE; }

void kicker_charge(kicker* k, uint64_t until_us) { k->charge_until_us = until_us; }

float kicker_pulse_of_speed(float v_kick_m_s) { return kPulsePerSpeed_s2_per_m * v_kick_m_s; }

int kicker_charged(const kicker* k) { return k->charging_s >= kChargeTime_s; }

static int its_moment(const kicker* k, int ball_seen, float yaw_error_rad) {
  if (k->moment == OMNIHIL_KICK_NOW) return 1;
  if (k->moment == OMNIHIL_KICK_AT_YAW) return fabsf(yaw_error_rad) <= kYawWindow_rad;
  return ball_seen;
}

kicker_output kicker_update(kicker* k, uint64_t now_us, float dt_s, int ball_seen, float yaw_error_rad) {
  kicker_output output = {OMNIHIL_KICK_NONE, 0u, 0.0f};
  if (k->kind != OMNIHIL_KICK_NONE && now_us > k->armed_until_us) kicker_disarm(k);
  if (k->kind != OMNIHIL_KICK_NONE && kicker_charged(k) && its_moment(k, ball_seen, yaw_error_rad)) {
    output.kick = k->kind;
    output.pulse_s = k->pulse_s;
    k->charging_s = 0.0f;
    kicker_disarm(k);
    k->charging = 0u; /* never charge while the coil is on */
    return output;
  }
  k->charging = k->kind != OMNIHIL_KICK_NONE || now_us < k->charge_until_us;
  if (k->charging && !kicker_charged(k)) k->charging_s += dt_s;
  output.charge = k->charging;
  return output;
}
