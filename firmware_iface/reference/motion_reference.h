/* What the wheel loops follow: the commanded motion, reached with an acceleration the tyres can take.
 *
 *   |d(v)/dt| <= 4 m/s^2,  |d(omega)/dt| <= 60 rad/s^2,  no wheel above 95 % of its no-load speed,
 *   no rim force above 0.55 of a quarter of the robot's weight (per mass: 0.55 g / 4; the mass cancels)
 *
 * Example: wheels at 45 deg, straight on: rim force m a / (4 cos 45 deg), so a <= 0.55 g cos 45 deg = 3.8 m/s^2.
 * Wheels far to the front and back push sideways badly; the limit there is lower, as it is for the
 * tyres. Where wheels would be too fast all four are slowed by one factor, so the robot keeps its direction.
 * The acceleration of the reference is handed on for the feed-forward. It is the inertial one,
 * a = d(v)/dt + omega x v: a robot that drives a circle at constant body velocity still needs force.
 * The wheels' own acceleration stands beside it: a robot that keeps its course while it turns needs that
 * alone. Numbers: guesses (+- 50 %) from robots of the league, which reach 3 to 6 m/s^2 on carpet.
 */
#ifndef OMNIHIL_REFERENCE_MOTION_REFERENCE_H
#define OMNIHIL_REFERENCE_MOTION_REFERENCE_H
#include "firmware_iface/reference/wheel_geometry.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct motion_reference {
  float body[BODY_AXES];       /* m/s, m/s, rad/s */
  float body_last[BODY_AXES];  /* one step ago, before motion_turn_under() */
  float body_accel[BODY_AXES]; /* inertial, in the body frame: m/s^2, m/s^2, rad/s^2 */
  float omega_wheel_rad_s[OMNIHIL_WHEELS];
  float wheel_accel_rad_s2[OMNIHIL_WHEELS];
  float wheel_limit_rad_s;
} motion_reference;

/* Takes up the motion the wheels have now: before the first step, after coasting or open loop. */
void motion_start(motion_reference* motion, const wheel_geometry* geometry,
                  const float omega_wheel_rad_s[OMNIHIL_WHEELS]);
void motion_toward_body(motion_reference* motion, const wheel_geometry* geometry,
                        const float target[BODY_AXES], float dt_s);
void motion_toward_wheels(motion_reference* motion, const wheel_geometry* geometry,
                          const float target_rad_s[OMNIHIL_WHEELS], float dt_s);
/* The body turned by this angle under a velocity that is fixed in the field: not an acceleration. */
void motion_turn_under(motion_reference* motion, float angle_rad);
int motion_is_rest(const motion_reference* motion);

#ifdef __cplusplus
}
#endif
#endif
