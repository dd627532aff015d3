/* Speed loop of one wheel: feed-forward of what the motor's equation says, PI(D) for what it does not.
 *
 *   u = k omega_ref + (R / k) tau_ff + p (omega_ref - omega) + I - d d(omega)/dt,   duty = u / u_bus
 *
 * k: torque constant (V s/rad), R: winding (ohm), tau_ff: torque the planned acceleration needs (N m), all at
 * the rotor. From the steady motor law u = k omega + R i, i = tau / k (eq. 7 with its speed factor).
 * The duty is limited to -1..1; while it is, the integral takes only what leads away from the limit. It may
 * fill up to half of the supply: what the winding of a strong motor drops at its largest current is a third
 * of it, and more would only make a wheel that was held race when it is let go (omnihil scenario run
 * wheel/wind_up: 1.7 times its target, 2.7 with encoders of 1024 counts, whose gains are lower; without these
 * rules 8 times), which takes 0.2 s to come back. Cannot: limit the current (the board's bridge does), nor
 * know a wheel in the air from one on the floor.
 */
#ifndef OMNIHIL_REFERENCE_WHEEL_CONTROLLER_H
#define OMNIHIL_REFERENCE_WHEEL_CONTROLLER_H

#ifdef __cplusplus
extern "C" {
#endif

/* All at the rotor. */
typedef struct wheel_gains {
  float p_V_s_per_rad;
  float i_V_per_rad;
  float d_V_s2_per_rad;
} wheel_gains;

typedef struct motor_constants {
  float resistance_ohm;
  float torque_constant_Nm_per_A;
} motor_constants;

typedef struct wheel_loop {
  float integral_V;
  float duty_ratio;
} wheel_loop;

typedef struct wheel_loop_input {
  float omega_ref_rad_s;
  float omega_rad_s;
  float accel_rad_s2;
  float torque_feedforward_Nm;
  float bus_V;
  float dt_s;
} wheel_loop_input;

/* Returns the duty, -1..1. */
float wheel_loop_update(wheel_loop* loop, const wheel_gains* gains, const motor_constants* motor,
                        const wheel_loop_input* input);
void wheel_loop_reset(wheel_loop* loop);

#ifdef __cplusplus
}
#endif
#endif
