/* Speed loop of one wheel by emotional learning (BELBIC), in the place of wheel_controller.h's PI.
 *
 * Amygdala A and orbitofrontal cortex O answer a stimulus S and learn from an emotional signal R:
 *   A = V S,   O = W S,   E = A - O                                  the answer
 *   dV/dt = alpha max(0, S (R - A)),   dW/dt = beta S (E - R)
 * The amygdala only learns; what it learned too much the orbitofrontal cortex inhibits. Here
 *   S = p e / u_bus,   R = S + (i / u_bus) integral of e dt,   e = omega_ref - omega of the rotor
 *   u = k omega_ref + (R_w / k) tau_ff + u_bus E                     feed-forward as in wheel_controller.h
 * with the PI's own gains p, i, so that both controllers know the same of the motor. S and R have signs: max(0, S (R - A))
 * is the published max(0, R - A) for a stimulus that may be negative. The integral stands while the duty is at its limit
 * and e drives deeper; V stays within 0..kMost, W within +-kMost.
 * Source: Moren and Balkenius 2000 (model of the amygdala), Lucas, Shahmirzadi and Sheikholeslami 2004 (as a controller);
 * the choice of S and R is ours, as the method leaves it. Cannot: promise stability; forget (V never falls but by reset).
 */
#ifndef OMNIHIL_REFERENCE_BELBIC_H
#define OMNIHIL_REFERENCE_BELBIC_H
#include "firmware_iface/reference/wheel_controller.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct belbic_rates {
  float amygdala_per_s;      /* alpha */
  float orbitofrontal_per_s; /* beta */
} belbic_rates;

typedef struct belbic_loop {
  float amygdala;      /* V */
  float orbitofrontal; /* W */
  float integral_rad;  /* of e */
  float duty_ratio;
} belbic_loop;

/* Chosen on a free wheel and on tuning drives, never on the drives that controllers are compared by. */
extern const belbic_rates kBelbicRates;

void belbic_reset(belbic_loop* loop);
/* Returns the duty, -1..1. */
float belbic_update(belbic_loop* loop, const belbic_rates* rates, const wheel_gains* gains,
                    const motor_constants* motor, const wheel_loop_input* input);

#ifdef __cplusplus
}
#endif
#endif
