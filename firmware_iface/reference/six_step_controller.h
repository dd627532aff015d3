/* Six-step commutation from Hall sensors, open loop (duty) or with a speed loop around it.
 *
 *   six_step_state state;
 *   six_step_reset(&state);
 *   six_step_update(&state, &settings, &input, &output);     // once per PWM period
 *   // output.leg[0 .. 2]: off, held low, or switched with output.duty_ratio
 *
 * Forward, sector n drives current into one phase and out of another so that its field leads the rotor by 90
 * degrees in the mean:   0: b -> c   1: b -> a   2: c -> a   3: c -> b   4: a -> b   5: a -> c
 * A negative duty swaps the two. Duty 0 holds all three legs low (brake) or all off (coast).
 * Speed loop, all at the rotor:  duty = (k omega_ref + p e + I) / bus,  I += i e dt, held while the duty is
 * at its limit and e would drive it deeper; e = omega_ref - omega from the Hall edges. On a fault of the
 * sensors all legs are off. Cannot: limit the current (give a duty limit or a bridge that does), start
 * against the wrong sensor order.
 */
#ifndef OMNIHIL_REFERENCE_SIX_STEP_CONTROLLER_H
#define OMNIHIL_REFERENCE_SIX_STEP_CONTROLLER_H

#include "firmware_iface/reference/six_step_hall.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum six_step_leg { SIX_STEP_LEG_OFF = 0, SIX_STEP_LEG_LOW = 1, SIX_STEP_LEG_PWM = 2 } six_step_leg;
typedef enum six_step_mode { SIX_STEP_DUTY = 0, SIX_STEP_SPEED = 1 } six_step_mode;

typedef struct six_step_settings {
  int pole_pairs;
  float back_emf_V_s_per_rad; /* k: of two phases, for the feed-forward */
  float p_V_s_per_rad;
  float i_V_per_rad;
  float duty_limit_ratio;
  int coast_at_zero; /* else brake */
} six_step_settings;

typedef struct six_step_input {
  six_step_mode mode;
  int hall_code;
  float duty_ratio;      /* SIX_STEP_DUTY: -1 .. 1 */
  float omega_ref_rad_s; /* SIX_STEP_SPEED: rotor */
  float bus_V;
  float dt_s;
} six_step_input;

typedef struct six_step_output {
  six_step_leg leg[3];
  float duty_ratio; /* of the switched leg, 0 .. 1 */
  float omega_rotor_rad_s;
  int fault;
} six_step_output;

typedef struct six_step_state {
  six_step_hall hall;
  float integral_V;
} six_step_state;

void six_step_reset(six_step_state* state);
void six_step_update(six_step_state* state, const six_step_settings* settings, const six_step_input* input,
                     six_step_output* output);

#ifdef __cplusplus
}
#endif
#endif
