/* Body velocity <-> wheel speed for four omni wheels at any angles: eq. (5) with the wheel radius in it.
 *
 *   omega_wheel_i = (-sin(a_i) v_forward + cos(a_i) v_left + R_b omega_body) / r
 *
 * a_i: angle of wheel i from body x (forward) towards y (left); R_b: centre to wheel contact; r: wheel
 * radius. The way back is the least-squares solution, the one that spreads encoder noise evenly over four
 * wheels. Example: a = 45 deg, r = 0.027 m, v_forward = 1 m/s gives omega_wheel = -26.2 rad/s. Cannot: see
 * slip. A wheel that spins on the spot shifts the estimate by a quarter of its rim speed.
 */
#ifndef OMNIHIL_REFERENCE_WHEEL_GEOMETRY_H
#define OMNIHIL_REFERENCE_WHEEL_GEOMETRY_H
#include "firmware_iface/omnihil_firmware.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { BODY_X = 0, BODY_Y = 1, BODY_OMEGA = 2, BODY_AXES = 3 };

typedef struct wheel_geometry {
  float wheel_radius_m;
  float rim_per_body[OMNIHIL_WHEELS][BODY_AXES]; /* rim speed (m/s) per body velocity (m/s, m/s, rad/s) */
  float body_per_rim[BODY_AXES][OMNIHIL_WHEELS]; /* least-squares inverse */
} wheel_geometry;

/* 0, or nonzero when the wheels cannot move the robot in every direction. */
int wheel_geometry_init(wheel_geometry* geometry, const omnihil_robot_config* config);

void body_to_wheels(const wheel_geometry* geometry, const float body[BODY_AXES],
                    float omega_wheel_rad_s[OMNIHIL_WHEELS]);
void wheels_to_body(const wheel_geometry* geometry, const float omega_wheel_rad_s[OMNIHIL_WHEELS],
                    float body[BODY_AXES]);

/* Smallest wheel torques that push the body with force (N, N) and torque (N m): the transpose of the inverse.
 */
void wrench_to_wheel_torques(const wheel_geometry* geometry, const float wrench[BODY_AXES],
                             float torque_wheel_Nm[OMNIHIL_WHEELS]);

/* Scales all speeds by one factor so that none exceeds the limit: the direction of motion is kept. */
void scale_to_limit(float omega_wheel_rad_s[OMNIHIL_WHEELS], float limit_rad_s);

#ifdef __cplusplus
}
#endif
#endif
