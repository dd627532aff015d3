/* Every field of the feedback, from what this firmware measures and computes. Where the board has no sensor
 * the field is 0: omega_dribbler_rad_s, DRIBBLER_SEES_BALL, KICKER_FAULT; where the firmware has
 * no such loop too: body_integral. body_target is the command in the body frame, body_output what the
 * reference allows of it now (fourth: what the yaw hold asks for, rad/s), body_derivative the estimate's
 * slope. */
#include <string.h>

#include "firmware_iface/reference/reference_firmware.h"

static uint32_t flags_of(const reference_state* state) {
  uint32_t flags = 0;
  if (state->watchdog.phase != LINK_LIVE) flags |= OMNIHIL_FEEDBACK_COMMAND_TIMEOUT;
  if (state->ticks > 0) flags |= OMNIHIL_FEEDBACK_IMU_READY | OMNIHIL_FEEDBACK_BALL_SENSOR_OK;
  if (state->ball_seen) flags |= OMNIHIL_FEEDBACK_BALL_SEEN;
  if (state->kick.charging) flags |= OMNIHIL_FEEDBACK_KICKER_ON;
  if (kicker_charged(&state->kick)) flags |= OMNIHIL_FEEDBACK_CAPACITOR_CHARGED;
  return flags;
}

static void report_wheels(const reference_state* state, omnihil_feedback* feedback) {
  double gear = (double)state->tuning.gear_ratio;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    const wheel_encoder* encoder = &state->encoder[w];
    feedback->omega_wheel_rad_s[w] = (double)encoder->omega_rotor_reported_rad_s / gear;
    feedback->omega_wheel_target_rad_s[w] = (double)state->motion.omega_wheel_rad_s[w];
    feedback->wheel_accel_rad_s2[w] = (double)encoder->accel_rotor_rad_s2 / gear;
    feedback->wheel_integral[w] = (double)state->loop[w].integral_V;
    feedback->duty_ratio[w] = (double)state->loop[w].duty_ratio;
  }
}

void reference_feedback(const reference_state* state, omnihil_feedback* feedback) {
  memset(feedback, 0, sizeof *feedback);
  feedback->now_us = state->now_us;
  feedback->flags = flags_of(state);
  feedback->command_age_ms = command_watchdog_age_ms(&state->watchdog, state->now_us);
  feedback->battery_V = (double)state->battery_V;
  feedback->capacitor_V = (double)state->capacitor_V;
  feedback->v_forward_m_s = (double)state->body_estimate[BODY_X];
  feedback->v_left_m_s = (double)state->body_estimate[BODY_Y];
  feedback->omega_body_rad_s = (double)state->body_estimate[BODY_OMEGA];
  feedback->yaw_rad = (double)state->yaw.yaw_rad;
  feedback->accel_x_m_s2 = (double)state->accel_m_s2[0];
  feedback->accel_y_m_s2 = (double)state->accel_m_s2[1];
  report_wheels(state, feedback);
  for (int axis = 0; axis < BODY_AXES; ++axis) {
    feedback->body_output[axis] = (double)state->motion.body[axis];
    feedback->body_target[axis] = (double)state->body_target[axis];
    feedback->body_derivative[axis] = (double)state->body_slope[axis];
  }
  feedback->body_output[3] = (double)state->yaw_output_rad_s;
  int holds_yaw = (state->command.flags & OMNIHIL_COMMAND_YAW_TARGET) != 0;
  feedback->body_target[3] = holds_yaw ? state->command.yaw_target_rad : 0.0;
  feedback->body_derivative[3] = (double)state->gyro_rad_s;
}
