/* One control period: sensors in, four bridges out. The order below is the firmware's whole story. */
#include <math.h>
#include <string.h>

#include "firmware_iface/reference/reference_firmware.h"

static const float kBatteryFilter_s = 0.1f;
static const float kSlopeFilter_s = 0.01f;
static const float kStandstillRim_m_s = 0.02f;
/* Below it the duty for a given voltage makes no sense: the supply is off or not measured. */
static const float kBusLow_V = 1.0f;

/* Takes over a measurement when it is a number; keeps the last good one otherwise. */
static int take(float* kept, double measured) {
  if (!isfinite(measured)) return 0;
  *kept = narrowed(measured);
  return 1;
}

static void read_sensors(reference_state* state, const omnihil_sensors* sensors, float dt_s) {
  int good = take(&state->bus_V, sensors->bus_voltage_V);
  good &= take(&state->gyro_rad_s, sensors->gyro_z_rad_s);
  good &= take(&state->accel_m_s2[0], sensors->accel_x_m_s2);
  good &= take(&state->accel_m_s2[1], sensors->accel_y_m_s2);
  if (!good) ++state->sensors_refused;
  if (state->ticks == 0) state->battery_V = state->bus_V;
  state->battery_V += dt_s / (kBatteryFilter_s + dt_s) * (state->bus_V - state->battery_V);
  state->ball_seen = sensors->ball_seen != 0u;
  take(&state->capacitor_V, sensors->capacitor_V);
  yaw_turn(&state->yaw, state->gyro_rad_s, dt_s);

  float omega_wheel_rad_s[OMNIHIL_WHEELS];
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    wheel_encoder_update(&state->encoder[w], &state->tuning.encoder, sensors->encoder_counts[w], dt_s);
    omega_wheel_rad_s[w] = state->encoder[w].omega_rotor_reported_rad_s / state->tuning.gear_ratio;
  }
  float before[BODY_AXES] = {state->body_estimate[0], state->body_estimate[1], state->body_estimate[2]};
  wheels_to_body(&state->geometry, omega_wheel_rad_s, state->body_estimate);
  for (int axis = 0; axis < BODY_AXES; ++axis) {
    float slope = (state->body_estimate[axis] - before[axis]) / dt_s;
    state->body_slope[axis] += dt_s / (kSlopeFilter_s + dt_s) * (slope - state->body_slope[axis]);
  }
}

static int wheels_stand(const reference_state* state) {
  float limit_rad_s = kStandstillRim_m_s / state->geometry.wheel_radius_m * state->tuning.gear_ratio;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    if (fabsf(state->encoder[w].omega_rotor_reported_rad_s) > limit_rad_s) return 0;
  }
  return 1;
}

/* The commanded body velocity in the body frame, with the yaw hold in it. */
static void find_body_target(reference_state* state) {
  const omnihil_command* command = &state->command;
  float x = narrowed(command->v_forward_m_s), y = narrowed(command->v_left_m_s);
  float* target = state->body_target;
  target[BODY_X] = x;
  target[BODY_Y] = y;
  if (command->flags & OMNIHIL_COMMAND_FIELD_FRAME) {
    /* v_body = R(-yaw) v_field */
    float c = cosf(state->yaw.yaw_rad), s = sinf(state->yaw.yaw_rad);
    target[BODY_X] = c * x + s * y;
    target[BODY_Y] = -s * x + c * y;
  }
  target[BODY_OMEGA] = narrowed(command->omega_body_rad_s);
  state->yaw_output_rad_s = 0.0f;
  if (command->flags & OMNIHIL_COMMAND_YAW_TARGET) {
    state->yaw_output_rad_s =
        yaw_hold(&state->yaw, (float)command->yaw_target_rad, (float)state->gains.p[LOOP_YAW]);
    target[BODY_OMEGA] = state->yaw_output_rad_s;
  }
}

static void move_reference(reference_state* state, uint32_t mode, float dt_s) {
  motion_reference* motion = &state->motion;
  const float rest[BODY_AXES] = {0.0f, 0.0f, 0.0f};
  motion->wheel_limit_rad_s =
      0.95f * state->bus_V / state->tuning.motor.torque_constant_Nm_per_A / state->tuning.gear_ratio;
  if (state->watchdog.phase == LINK_STOPPING) {
    memset(state->body_target, 0, sizeof state->body_target);
    motion_toward_body(motion, &state->geometry, rest, dt_s);
  } else if (mode == OMNIHIL_MODE_WHEEL_SPEED) {
    float target_rad_s[OMNIHIL_WHEELS];
    for (int w = 0; w < OMNIHIL_WHEELS; ++w) target_rad_s[w] = narrowed(state->command.omega_wheel_rad_s[w]);
    wheels_to_body(&state->geometry, target_rad_s, state->body_target);
    motion_toward_wheels(motion, &state->geometry, target_rad_s, dt_s);
  } else {
    find_body_target(state);
    if (state->command.flags & OMNIHIL_COMMAND_FIELD_FRAME)
      motion_turn_under(motion, state->gyro_rad_s * dt_s);
    motion_toward_body(motion, &state->geometry, state->body_target, dt_s);
  }
}

static void close_loops(reference_state* state, float dt_s) {
  const wheel_tuning* tuning = &state->tuning;
  const motion_reference* motion = &state->motion;
  /* F = m a, M = J alpha: shared out to the wheels, felt at the rotors */
  const float wrench[BODY_AXES] = {tuning->mass_kg * motion->body_accel[BODY_X],
                                   tuning->mass_kg * motion->body_accel[BODY_Y],
                                   tuning->yaw_inertia_kg_m2 * motion->body_accel[BODY_OMEGA]};
  float torque_wheel_Nm[OMNIHIL_WHEELS];
  wrench_to_wheel_torques(&state->geometry, wrench, torque_wheel_Nm);
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    const wheel_encoder* encoder = &state->encoder[w];
    if (wheel_encoder_faulty(encoder)) {
      wheel_loop_reset(&state->loop[w]);
      belbic_reset(&state->emotion[w]);
      continue; /* stays in coast */
    }
    /* tau = r F / gear + J_free d(omega_rotor)/dt */
    float torque_rotor_Nm = torque_wheel_Nm[w] / tuning->gear_ratio +
                            tuning->inertia_free_kg_m2 * motion->wheel_accel_rad_s2[w] * tuning->gear_ratio;
    const wheel_loop_input input = {.omega_ref_rad_s = motion->omega_wheel_rad_s[w] * tuning->gear_ratio,
                                    .omega_rad_s = encoder->omega_rotor_rad_s,
                                    .accel_rad_s2 = encoder->accel_rotor_rad_s2,
                                    .torque_feedforward_Nm = torque_rotor_Nm,
                                    .bus_V = state->bus_V,
                                    .dt_s = dt_s};
    state->drive.mode[w] = OMNIHIL_DRIVE_DUTY;
    state->drive.duty_ratio[w] =
        (double)(state->emotional
                     ? belbic_update(&state->emotion[w], &kBelbicRates, &tuning->gains, &tuning->motor,
                                     &input)
                     : wheel_loop_update(&state->loop[w], &tuning->gains, &tuning->motor, &input));
  }
}

static void let_go(reference_state* state) {
  const float still[OMNIHIL_WHEELS] = {0.0f, 0.0f, 0.0f, 0.0f};
  motion_start(&state->motion, &state->geometry, still);
  memset(state->body_target, 0, sizeof state->body_target);
  state->yaw_output_rad_s = 0.0f;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    wheel_loop_reset(&state->loop[w]);
    state->emotion[w].integral_rad = 0.0f; /* what was learned stays */
  }
  state->following = 0;
}

static void drive_wheels(reference_state* state, float dt_s) {
  uint32_t mode = state->command.mode;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    state->drive.mode[w] = OMNIHIL_DRIVE_COAST;
    state->drive.duty_ratio[w] = 0.0;
  }
  if (state->watchdog.phase == LINK_SILENT || mode == OMNIHIL_MODE_COAST || state->bus_V < kBusLow_V) {
    let_go(state);
    return;
  }
  if (mode == OMNIHIL_MODE_WHEEL_DUTY && state->watchdog.phase == LINK_LIVE) {
    let_go(state);
    for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
      state->drive.mode[w] = OMNIHIL_DRIVE_DUTY;
      state->drive.duty_ratio[w] = state->command.duty_ratio[w];
      state->loop[w].duty_ratio = (float)state->command.duty_ratio[w];
    }
    return;
  }
  if (!state->following) {
    float omega_wheel_rad_s[OMNIHIL_WHEELS];
    for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
      omega_wheel_rad_s[w] = state->encoder[w].omega_rotor_reported_rad_s / state->tuning.gear_ratio;
    }
    motion_start(&state->motion, &state->geometry, omega_wheel_rad_s);
    state->following = 1;
  }
  move_reference(state, mode, dt_s);
  close_loops(state, dt_s);
}

static void drive_kicker(reference_state* state, float dt_s) {
  float yaw_error_rad = wrap_angle((float)state->command.yaw_target_rad - state->yaw.yaw_rad);
  kicker_output kick =
      kicker_update(&state->kick, state->now_us, dt_s, state->ball_seen != 0u, yaw_error_rad);
  state->drive.kick = kick.kick;
  state->drive.charge = kick.charge;
  state->drive.kick_pulse_s = (double)kick.pulse_s;
  int live = state->watchdog.phase == LINK_LIVE;
  state->drive.dribbler_ratio = live ? state->command.dribbler_ratio : 0.0;
}

void reference_tick(reference_state* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  /* the true time since the last tick; at the first, and when time stands or jumps, the nominal period */
  uint64_t elapsed_us = sensors->now_us - state->now_us;
  int plausible = state->ticks > 0 && elapsed_us > 0 && elapsed_us <= 10u * REFERENCE_PERIOD_US;
  float dt_s = (float)(plausible ? elapsed_us : REFERENCE_PERIOD_US) * 1e-6f;
  state->now_us = sensors->now_us;

  read_sensors(state, sensors, dt_s);
  int driven = state->drive.mode[0] == OMNIHIL_DRIVE_DUTY || state->following;
  int at_rest = motion_is_rest(&state->motion) && wheels_stand(state);
  command_watchdog_update(&state->watchdog, state->now_us, driven, at_rest);
  drive_wheels(state, dt_s);
  drive_kicker(state, dt_s);
  ++state->ticks;
  *drive = state->drive;
}
