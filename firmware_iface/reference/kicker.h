/* Kicker: charge on demand, hold an armed kick until its moment, fire once, charge again.
 *
 * The board measures no capacitor voltage, so "charged" is 1 s of charging since the last kick (the time
 * ULaval's robots use). An armed kick charges by itself. It fires for one control tick, with its pulse
 * length beside it; on the ball, at once, or when the heading is within 2 degrees of the target.
 * A kick speed becomes a pulse by pulse = 1 ms per m/s (guess, +- 50 %: a real kicker needs its own table).
 */
#ifndef OMNIHIL_REFERENCE_KICKER_H
#define OMNIHIL_REFERENCE_KICKER_H
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct kicker {
  uint64_t armed_until_us;
  uint64_t charge_until_us;
  uint32_t kind;   /* OMNIHIL_KICK_STRAIGHT, _CHIP; OMNIHIL_KICK_NONE: not armed */
  uint32_t moment; /* OMNIHIL_KICK_ON_BALL, _NOW, _AT_YAW */
  float pulse_s;
  float charging_s; /* since the last kick */
  uint32_t charging;
} kicker;

typedef struct kicker_output {
  uint32_t kick;
  uint32_t charge;
  float pulse_s;
} kicker_output;

void kicker_arm(kicker* k, uint32_t kind, uint32_t moment, float pulse_s, uint64_t until_us);
void kicker_disarm(kicker* k);
void kicker_charge(kicker* k, uint64_t until_us);
float kicker_pulse_of_speed(float v_kick_m_s);
int kicker_charged(const kicker* k);
kicker_output kicker_update(kicker* k, uint64_t now_us, float dt_s, int ball_seen, float yaw_error_rad);

#ifdef __cplusplus
}
#endif
#endif
