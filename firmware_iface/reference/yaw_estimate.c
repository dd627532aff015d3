#include "firmware_iface/reference/yaw_estimate.h"

#include <math.h>

static const float kTwoPi = 6.28318531f;
static const float kCameraShare = 0.05f;
static const float kYawRateLimit_rad_s = 8.0f;

float wrap_angle(float angle_rad) { return angle_rad - kTwoPi * floorf(angle_rad / kTwoPi + 0.5f); }

void yaw_turn(yaw_estimate* yaw, float gyro_rad_s, float dt_s) {
  yaw->yaw_rad = wrap_angle(yaw->yaw_rad + gyro_rad_s * dt_s);
}

void yaw_camera(yaw_estimate* yaw, float camera_yaw_rad) {
  float share = yaw->camera_seen ? kCameraShare : 1.0f;
  yaw->camera_seen = 1;
  yaw->yaw_rad = wrap_angle(yaw->yaw_rad + share * wrap_angle(camera_yaw_rad - yaw->yaw_rad));
}

float yaw_hold(const yaw_estimate* yaw, float target_rad, float p_per_s) {
  float omega_rad_s = p_per_s * wrap_angle(target_rad - yaw->yaw_rad);
  return fmaxf(-kYawRateLimit_rad_s, fminf(kYawRateLimit_rad_s, omega_rad_s));
}
