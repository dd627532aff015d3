/* Field-oriented control: two current loops in the rotor's frame, a speed loop around them.
 *
 *   foc_tune(&gains, &motor, 2 * pi * 1000, 2 * pi * 30, 10);   // bandwidths of current and speed, limit 10 A
 *   foc_update(&state, &motor, &gains, &input, &output);        // once per PWM period
 *   // output.duty_ratio[0 .. 2] go to the three half bridges
 *
 * Law:
 *   i_q* = p_w (omega* - omega) + I_w, within +- limit;  i_d* = 0
 *   v_d = p (i_d* - i_d) + I_d - omega_e L_q i_q,   v_q = p (i_q* - i_q) + I_q + omega_e (L_d i_d + lambda)
 * v is held within bus / sqrt(3) (d first); while it is, the integrals take only what leads back.
 * Gains: p = L w_c, i = R w_c cancels the winding's pole and leaves a current loop of first order, bandwidth
 * w_c; p_w = J w_s / (3/2 p lambda), i_w = p_w w_s / 4 gives two equal poles at w_s / 2.
 * The voltage acts later than the currents were sampled: it is laid out for the angle `delay_s` ahead.
 * Source: Holmes, McGrath, Parker 2012, "Current regulation strategies for vector-controlled induction motor
 * drives" (tuning, delay); Krause et al. 2002.
 * Cannot: weaken the field above base speed, compensate dead time, find the angle without a sensor.
 */
#ifndef OMNIHIL_REFERENCE_FOC_CONTROLLER_H
#define OMNIHIL_REFERENCE_FOC_CONTROLLER_H

#include "firmware_iface/reference/foc_transform.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct foc_motor {
  float resistance_ohm; /* phase to star, as the inductances */
  float inductance_d_H, inductance_q_H;
  float flux_linkage_Wb;
  float inertia_kg_m2; /* of all that turns with the rotor */
  int pole_pairs;
} foc_motor;

typedef struct foc_gains {
  float d_p_V_per_A, q_p_V_per_A;
  float current_i_V_per_A_s;
  float speed_p_A_s_per_rad;
  float speed_i_A_per_rad;
  float current_limit_A; /* of i_q */
} foc_gains;

typedef enum foc_mode { FOC_CURRENT = 0, FOC_SPEED = 1 } foc_mode;

typedef struct foc_input {
  foc_mode mode;
  float current_A[3]; /* into the motor */
  float theta_elec_rad;
  float omega_rotor_rad_s;
  float i_q_ref_A;       /* FOC_CURRENT */
  float omega_ref_rad_s; /* FOC_SPEED, rotor */
  float bus_V;
  float dt_s;
  float delay_s; /* from the sample to the middle of the period the duties act in */
} foc_input;

typedef struct foc_output {
  float duty_ratio[3];
  float i_d_A, i_q_A;
  float v_d_V, v_q_V;
  float i_q_ref_A;
  int saturated; /* the voltage was at its limit */
} foc_output;

typedef struct foc_state {
  float integral_d_V, integral_q_V, integral_speed_A;
} foc_state;

void foc_tune(foc_gains* gains, const foc_motor* motor, float current_bandwidth_rad_s,
              float speed_bandwidth_rad_s, float current_limit_A);
void foc_reset(foc_state* state);
void foc_update(foc_state* state, const foc_motor* motor, const foc_gains* gains, const foc_input* input,
                foc_output* output);

#ifdef __cplusplus
}
#endif
#endif
