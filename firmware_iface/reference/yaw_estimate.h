/* Heading: the gyro, integrated, pulled towards the camera's heading when a command brings one.
 *
 *   yaw += gyro dt;   camera: the first is taken over, each later one pulls by 5 % of the difference
 *
 * Also the yaw hold: omega = p wrap(target - yaw), at most 8 rad/s.
 * Cannot: know the camera's delay (typically 10 to 50 ms), so yaw lags while the robot turns fast;
 * estimate the gyro's bias.
 */
#ifndef OMNIHIL_REFERENCE_YAW_ESTIMATE_H
#define OMNIHIL_REFERENCE_YAW_ESTIMATE_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct yaw_estimate {
  float yaw_rad;
  int camera_seen;
} yaw_estimate;

float wrap_angle(float angle_rad); /* to -pi..pi */
void yaw_turn(yaw_estimate* yaw, float gyro_rad_s, float dt_s);
void yaw_camera(yaw_estimate* yaw, float camera_yaw_rad);
float yaw_hold(const yaw_estimate* yaw, float target_rad, float p_per_s);

#ifdef __cplusplus
}
#endif
#endif
