/* What a command does when it arrives: checked as a whole, then taken over; a bad one changes nothing. */
#include <math.h>

#include "firmware_iface/reference/reference_firmware.h"

static const double kTwoPi = 6.283185307179586;
static const uint64_t kKickWait_us =
    1000000u; /* how long a kick waits for its moment without a new command */

float narrowed(double value) { return (float)fmax(-1e30, fmin(1e30, value)); }

static int duties_valid(const omnihil_command* command) {
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    if (!(fabs(command->duty_ratio[w]) <= 1.0)) return 0;
  }
  return 1;
}

static int command_valid(const omnihil_command* command) {
  const double numbers[] = {
      command->v_forward_m_s,           command->v_left_m_s,     command->omega_body_rad_s,
      command->yaw_target_rad,          command->camera_yaw_rad, command->a_feedforward_m_s2,
      command->a_feedforward_angle_rad, command->v_kick_m_s,     command->kick_pulse_s,
      command->dribbler_ratio};
  for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i) {
    if (!isfinite(numbers[i])) return 0;
  }
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    if (!isfinite(command->omega_wheel_rad_s[w])) return 0;
  }
  return duties_valid(command) && command->mode <= OMNIHIL_MODE_WHEEL_DUTY &&
         command->kick <= OMNIHIL_KICK_CHIP && command->kick_when <= OMNIHIL_KICK_AT_YAW &&
         command->dribbler_ratio >= 0.0 && command->dribbler_ratio <= 1.0 && command->v_kick_m_s >= 0.0 &&
         command->kick_pulse_s >= 0.0;
}

int reference_take_motion(reference_state* state, const omnihil_command* command, uint64_t now_us) {
  if (!command_valid(command)) {
    ++state->commands_refused;
    return 1;
  }
  state->command = *command;
  /* any finite angle, brought to -pi..pi before it becomes a float */
  state->command.yaw_target_rad = remainder(command->yaw_target_rad, kTwoPi);
  command_watchdog_feed(&state->watchdog, now_us);
  if (command->flags & OMNIHIL_COMMAND_CAMERA_YAW) {
    yaw_camera(&state->yaw, (float)remainder(command->camera_yaw_rad, kTwoPi));
  }
  return 0;
}

int reference_take_command(reference_state* state, const omnihil_command* command, uint64_t now_us) {
  if (reference_take_motion(state, command, now_us) != 0) return 1;
  /* charging lasts as long as commands ask for it */
  int charge = (command->flags & OMNIHIL_COMMAND_CHARGE) != 0;
  kicker_charge(&state->kick, charge ? now_us + state->watchdog.timeout_us : 0u);
  if (command->kick == OMNIHIL_KICK_NONE) {
    kicker_disarm(&state->kick);
  } else {
    float pulse_s = command->kick_pulse_s > 0.0 ? narrowed(command->kick_pulse_s)
                                                : kicker_pulse_of_speed(narrowed(command->v_kick_m_s));
    kicker_arm(&state->kick, command->kick, command->kick_when, pulse_s, now_us + kKickWait_us);
  }
  return 0;
}
