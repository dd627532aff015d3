#include "firmware_iface/reference/motion_reference.h"

#include <math.h>

static const float kAccelLimit_m_s2 = 4.0f;
static const float kYawAccelLimit_rad_s2 = 60.0f;
/* Beyond any robot; brings numbers like 3e38 down before they are multiplied. Keeps the direction. */
static const float kSpeedOfNoRobot_m_s = 100.0f;

static float toward(float from, float to, float step) {
  float gap = to - from;
  return fabsf(gap) <= step ? to : from + copysignf(step, gap);
}

static void note_acceleration(motion_reference* motion, const float before[BODY_AXES], float dt_s) {
  const float* body = motion->body;
  float omega_rad_s = body[BODY_OMEGA];
  /* a = d(v)/dt + omega x v */
  motion->body_accel[BODY_X] = (body[BODY_X] - before[BODY_X]) / dt_s - omega_rad_s * body[BODY_Y];
  motion->body_accel[BODY_Y] = (body[BODY_Y] - before[BODY_Y]) / dt_s + omega_rad_s * body[BODY_X];
  motion->body_accel[BODY_OMEGA] = (omega_rad_s - before[BODY_OMEGA]) / dt_s;
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
  for (int axis = 0; axis < BODY_AXES; ++axis) motion->body_accel[axis] = 0.0f;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) motion->wheel_accel_rad_s2[w] = 0.0f;
}

void motion_toward_body(motion_reference* motion, const wheel_geometry* geometry,
                        const float target[BODY_AXES], float dt_s) {
  float before[BODY_AXES] = {motion->body[BODY_X], motion->body[BODY_Y], motion->body[BODY_OMEGA]};
  float largest = fmaxf(fmaxf(fabsf(target[BODY_X]), fabsf(target[BODY_Y])), fabsf(target[BODY_OMEGA]));
  float scale = largest > kSpeedOfNoRobot_m_s ? kSpeedOfNoRobot_m_s / largest : 1.0f;
  float goal[BODY_AXES] = {target[BODY_X] * scale, target[BODY_Y] * scale, target[BODY_OMEGA] * scale};

  float wheels[OMNIHIL_WHEELS];
  body_to_wheels(geometry, goal, wheels);
  scale_to_limit(wheels, motion->wheel_limit_rad_s);
  wheels_to_body(geometry, wheels, goal);

  float gap_x = goal[BODY_X] - before[BODY_X], gap_y = goal[BODY_Y] - before[BODY_Y];
  float gap_m_s = sqrtf(gap_x * gap_x + gap_y * gap_y);
  float step_m_s = kAccelLimit_m_s2 * dt_s;
  float share = gap_m_s > step_m_s ? step_m_s / gap_m_s : 1.0f;
  motion->body[BODY_X] = share < 1.0f ? before[BODY_X] + share * gap_x : goal[BODY_X];
  motion->body[BODY_Y] = share < 1.0f ? before[BODY_Y] + share * gap_y : goal[BODY_Y];
  motion->body[BODY_OMEGA] = toward(before[BODY_OMEGA], goal[BODY_OMEGA], kYawAccelLimit_rad_s2 * dt_s);
  body_to_wheels(geometry, motion->body, wheels);
  set_wheels(motion, wheels, dt_s);
  note_acceleration(motion, before, dt_s);
}

void motion_toward_wheels(motion_reference* motion, const wheel_geometry* geometry,
                          const float target_rad_s[OMNIHIL_WHEELS], float dt_s) {
  float before[BODY_AXES] = {motion->body[BODY_X], motion->body[BODY_Y], motion->body[BODY_OMEGA]};
  float limit_rad_s = motion->wheel_limit_rad_s;
  float step_rad_s = kAccelLimit_m_s2 / geometry->wheel_radius_m * dt_s;
  float wheels[OMNIHIL_WHEELS];
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    float goal_rad_s = fmaxf(-limit_rad_s, fminf(limit_rad_s, target_rad_s[w]));
    wheels[w] = toward(motion->omega_wheel_rad_s[w], goal_rad_s, step_rad_s);
  }
  set_wheels(motion, wheels, dt_s);
  wheels_to_body(geometry, motion->omega_wheel_rad_s, motion->body);
  note_acceleration(motion, before, dt_s);
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
