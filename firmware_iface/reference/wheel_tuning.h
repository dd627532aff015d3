/* Gains and filters from the data sheet: what a robot's configuration says, and guesses for what it does not.
 *
 * Per rotor, J is what the motor feels: J_loaded when the robot moves straight, J_free when the wheel spins
 * in the air. Without delay the speed loop's bandwidth is (p + k) k / (J R). p is the smaller of
 *   - the one that gives 40 rad/s on the floor (J_loaded): quick enough for a robot, gentle to the tyres;
 *   - the one that keeps bandwidth times delay <= 0.8 for a free wheel (J_free): a lifted robot must not howl.
 * i makes the loaded loop critically damped: i = (p + k) bandwidth / 4. Source of the rules: second-order
 * closed loop s^2 + b s + i k / (J R), double root at i = b^2 J R / (4 k). Valid for R, k of any
 * small brushed or brushless drive; the guesses below are +- 50 %.
 */
#ifndef OMNIHIL_REFERENCE_WHEEL_TUNING_H
#define OMNIHIL_REFERENCE_WHEEL_TUNING_H
#include "firmware_iface/omnihil_firmware.h"
#include "firmware_iface/reference/wheel_controller.h"
#include "firmware_iface/reference/wheel_encoder.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct wheel_tuning {
  motor_constants motor;
  encoder_setup encoder;
  wheel_gains gains;
  float gear_ratio;
  float inertia_free_kg_m2; /* at the rotor, wheel in the air */
  float mass_kg;            /* guess, for the acceleration feed-forward */
  float yaw_inertia_kg_m2;  /* guess */
} wheel_tuning;

void wheel_tuning_init(wheel_tuning* tuning, const omnihil_robot_config* config, float period_s);

#ifdef __cplusplus
}
#endif
#endif
