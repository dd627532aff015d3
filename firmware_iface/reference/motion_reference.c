#include "firmware_iface/reference/motion_reference.h"

#include <math.h>

static const float kAccelLimit_m_s2 = 4.0f;
static const float kGrip =
    0.55f; /* friction coefficient to plan with; omni wheels on carpet have 0.6 to 0.8 */
static const float kQuarterGravity_m_s2 = 9.81f / 4.0f;
static const float kYawAccelLimit_rad_s2 = 60.0f;
/* Beyond any robot; brings numbers like 3e38 down before they are multiplied. Keeps the direction. */
static const float kSpeedOfNoRobot_m_s = 100.0f, kYawRateOfNoRobot_rad_s = 1000.0f;

static float step_share(float gap, float step) { return gap > step ? step / gap : 1.0f; }

/* The share of this change per `dt_s` that the tyres can transmit: 1, or what brings the hardest-worked wheel
 * to its limit. Forces per mass; the radius of gyration is that of a disc of the wheels' radius, R_b^2 / 2.
 */
static float grip_share(const wheel_geometry* geometry, const float change[BODY_AXES], float dt_s) {
  float center_m = geometry->rim_per_body[0][BODY_OMEGA];
  float hardest = 0.0f;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    float force_per_mass =
        geometry->body_per_rim[BODY_X][w] * change[BODY_X] +
        geometry->body_per_rim[BODY_Y][w] * change[BODY_Y] +
        geometry->body_per_rim[BODY_OMEGA][w] * 0.5f * center_m * center_m * change[BODY_OMEGA];
    hardest = fmaxf(hardest, fabsf(force_per_mass));
  }
  float limit = kGrip * kQuarterGravity_m_s2 * dt_s;
  return hardest > limit ? limit / hardest : 1.0f;
}

static void note_acceleration(motion_reference* motion, float dt_s) {
  const float* body = motion->body;
  float* last = motion->body_last;
  float omega_rad_s = body[BODY_OMEGA];
  /* a = d(v)/dt + omega x v */
  motion->body_accel[BODY_X] = (body[BODY_X] - last[BODY_X]) / dt_s - omega_rad_s * body[BODY_Y];
  motion->body_accel[BODY_Y] = (body[BODY_Y] - last[BODY_Y]) / dt_s + omega_rad_s * body[BODY_X];
  motion->body_accel[BODY_OMEGA] = (omega_rad_s - last[BODY_OMEGA]) / dt_s;
  for (int axis = 0; axis < BODY_AXES; ++axis) last[axis] = body[axis];
}

static void set_wheels(motion_reference* motion, const float wheels[OMNIHIL_WHEELS], float dt_s) {
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    motion->wheel_accel_rad_s2[w] = (wheels[w] - motion->omega_wheel_rad_s[w]) / dt_s;
    motion->omega_wheel_rad_s[w] = wheels[w];
  }
}

void motion_start(motion_reference* motion, const wheel_geometry* geometry,
                  const float omega_wheel_rad_s[OMNIHIL_WHEELS]) {
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) motion->omega_wheel_rad_s[w] = omega_wheel_rad_s[w];
  wheels_to_body(geometry, omega_wheel_rad_s, motion->body);
  for (int axis = 0; axis < BODY_AXES; ++axis) {
    motion->body_last[axis] = motion->body[axis];
    motion->body_accel[axis] = 0.0f;
  }
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) motion->wheel_accel_rad_s2[w] = 0.0f;
}

void motion_toward_body(motion_reference* motion, const wheel_geometry* geometry,
                        const float target[BODY_AXES], float dt_s) {
  float before[BODY_AXES] = {motion->body[BODY_X], motion->body[BODY_Y], motion->body[BODY_OMEGA]};
  float excess = fmaxf(fmaxf(fabsf(target[BODY_X]), fabsf(target[BODY_Y])) / kSpeedOfNoRobot_m_s,
                       fabsf(target[BODY_OMEGA]) / kYawRateOfNoRobot_rad_s);
  float scale = excess > 1.0f ? 1.0f / excess : 1.0f;
  float goal[BODY_AXES] = {target[BODY_X] * scale, target[BODY_Y] * scale, target[BODY_OMEGA] * scale};

  float wheels[OMNIHIL_WHEELS];
  body_to_wheels(geometry, goal, wheels);
  scale_to_limit(wheels, motion->wheel_limit_rad_s);
  wheels_to_body(geometry, wheels, goal);

  float change[BODY_AXES];
  for (int axis = 0; axis < BODY_AXES; ++axis) change[axis] = goal[axis] - before[axis];
  float gap_m_s = sqrtf(change[BODY_X] * change[BODY_X] + change[BODY_Y] * change[BODY_Y]);
  float share = step_share(gap_m_s, kAccelLimit_m_s2 * dt_s);
  change[BODY_X] *= share;
  change[BODY_Y] *= share;
  change[BODY_OMEGA] *= step_share(fabsf(change[BODY_OMEGA]), kYawAccelLimit_rad_s2 * dt_s);
  share = grip_share(geometry, change, dt_s);
  for (int axis = 0; axis < BODY_AXES; ++axis) motion->body[axis] = before[axis] + share * change[axis];
  body_to_wheels(geometry, motion->body, wheels);
  set_wheels(motion, wheels, dt_s);
  note_acceleration(motion, dt_s);
}

void motion_toward_wheels(motion_reference* motion, const wheel_geometry* geometry,
                          const float target_rad_s[OMNIHIL_WHEELS], float dt_s) {
  float limit_rad_s = motion->wheel_limit_rad_s;
  float step_rad_s = kAccelLimit_m_s2 / geometry->wheel_radius_m * dt_s;
  float wheels[OMNIHIL_WHEELS], body_change[BODY_AXES];
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    float goal_rad_s = fmaxf(-limit_rad_s, fminf(limit_rad_s, target_rad_s[w]));
    float gap_rad_s = goal_rad_s - motion->omega_wheel_rad_s[w];
    wheels[w] = gap_rad_s * step_share(fabsf(gap_rad_s), step_rad_s);
  }
  wheels_to_body(geometry, wheels, body_change);
  float share = grip_share(geometry, body_change, dt_s);
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) wheels[w] = motion->omega_wheel_rad_s[w] + share * wheels[w];
  set_wheels(motion, wheels, dt_s);
  wheels_to_body(geometry, motion->omega_wheel_rad_s, motion->body);
  note_acceleration(motion, dt_s);
}

void motion_turn_under(motion_reference* motion, float angle_rad) {
  float c = cosf(angle_rad), s = sinf(angle_rad);
  float x = motion->body[BODY_X], y = motion->body[BODY_Y];
  motion->body[BODY_X] = c * x + s * y;
  motion->body[BODY_Y] = -s * x + c * y;
}

int motion_is_rest(const motion_reference* motion) {
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    if (motion->omega_wheel_rad_s[w] != 0.0f) return 0;
  }
  return 1;
}
