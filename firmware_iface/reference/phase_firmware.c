#include "firmware_iface/reference/phase_firmware.h"

#include <math.h>
#include <string.h>

static const float kTwoPi = 6.28318531f;
static const float kCurrentBandwidth_Hz = 1000.0f;
static const float kPwmPerCurrentBandwidth = 20.0f; /* 1.5 periods of delay then cost 27 degrees */
static const float kSpeedBandwidth_rad_s = 75.0f;   /* 12 Hz: a twelfth of what the 1 ms speed allows */
static const float kCurrentLimit_A = 15.0f;         /* where the board names none; of a pair, as its own */
static const float kLimitShare = 0.9f;              /* stays below the board's own */
static const float kPeakPerPair = 1.15470054f;      /* i_q over the DC-equivalent current: 2 / sqrt(3) */

static int motor_init(void* block, const omnihil_motor_config* motors) {
  phase_state* state = block;
  const double positive[] = {motors->pwm_frequency_Hz,     motors->phase_resistance_ohm,
                             motors->phase_inductance_d_H, motors->phase_inductance_q_H,
                             motors->flux_linkage_Wb,      motors->rotor_inertia_kg_m2};
  for (size_t i = 0; i < sizeof positive / sizeof positive[0]; ++i) {
    if (!(positive[i] > 0.0) || !isfinite(positive[i])) return REFERENCE_MOTOR_NOT_POSITIVE;
  }
  if (motors->pole_pairs == 0u) return REFERENCE_MOTOR_NOT_POSITIVE;
  const wheel_tuning* tuning = &state->base.tuning;
  /* per rotor: what turns with it, and a robot that moves straight (wheel_tuning.h) */
  float way_m = (float)state->base.config.wheel_radius_m / tuning->gear_ratio;
  float inertia_kg_m2 = tuning->inertia_free_kg_m2 + 0.5f * tuning->mass_kg * way_m * way_m;
  state->motors = *motors;
  state->period_s = 1.0f / (float)motors->pwm_frequency_Hz;
  state->motor.resistance_ohm = (float)motors->phase_resistance_ohm;
  state->motor.inductance_d_H = (float)motors->phase_inductance_d_H;
  state->motor.inductance_q_H = (float)motors->phase_inductance_q_H;
  state->motor.flux_linkage_Wb = (float)motors->flux_linkage_Wb;
  state->motor.inertia_kg_m2 = inertia_kg_m2;
  state->motor.pole_pairs = (int)motors->pole_pairs;
  float limit_A =
      motors->current_limit_A > 0.0 ? kLimitShare * (float)motors->current_limit_A : kCurrentLimit_A;
  float bandwidth_Hz = fminf(kCurrentBandwidth_Hz, (float)motors->pwm_frequency_Hz / kPwmPerCurrentBandwidth);
  foc_tune(&state->gains, &state->motor, kTwoPi * bandwidth_Hz, kSpeedBandwidth_rad_s,
           kPeakPerPair * limit_A);
  state->six_step.pole_pairs = (int)motors->pole_pairs;
  state->six_step.duty_limit_ratio = 1.0f;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) six_step_reset(&state->wheel[w].six_step);
  state->ready = 1;
  return 0;
}

static int init(void* block, const omnihil_robot_config* config) {
  phase_state* state = block;
  memset(state, 0, sizeof *state);
  return omnihil_reference_firmware()->init(&state->base, config);
}

/* tick() of the reference firmware may have started it anew: the motors stay known. */
static void tick_base(phase_state* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  omnihil_reference_firmware()->tick(&state->base, sensors, drive);
  if (!state->ready) return;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    phase_wheel* wheel = &state->wheel[w];
    wheel->mode = drive->mode[w] == OMNIHIL_DRIVE_DUTY ? PHASE_VOLTAGE : PHASE_OFF;
    wheel->duty_ratio = (float)drive->duty_ratio[w];
    drive->mode[w] = OMNIHIL_DRIVE_PHASES;
    drive->duty_ratio[w] = 0.0;
  }
}

static void foc_tick(void* block, const omnihil_sensors* sensors, omnihil_drive* drive) {
  phase_state* state = block;
  tick_base(state, sensors, drive);
  if (!state->ready || !state->base.following) return;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    phase_wheel* wheel = &state->wheel[w];
    if (wheel->mode != PHASE_VOLTAGE) continue;
    wheel->mode = PHASE_SPEED;
    wheel->omega_ref_rad_s = state->base.motion.omega_wheel_rad_s[w] * state->base.tuning.gear_ratio;
    state->base.loop[w].integral_V = 0.0f; /* that loop is not in use */
  }
}

static void six_step_tick(void* block, const omnihil_sensors* sensors, omnihil_drive* drive) {
  tick_base(block, sensors, drive);
}

static void set_legs(omnihil_motor_drive* drive, int w, const float duty_ratio[OMNIHIL_LEGS]) {
  for (int x = 0; x < OMNIHIL_LEGS; ++x) {
    drive->leg[w][x] = OMNIHIL_LEG_PWM;
    drive->leg_duty_ratio[w][x] = (double)duty_ratio[x];
  }
}

/* No loop: the voltage of a duty along q, at the angle of the middle of the next period. */
static void voltage_along_q(const phase_state* state, const foc_input* input, float duty_ratio,
                            float out[OMNIHIL_LEGS]) {
  float ahead_rad =
      input->theta_elec_rad + (float)state->motor.pole_pairs * input->omega_rotor_rad_s * input->delay_s;
  foc_dq v = {0.0f, duty_ratio * input->bus_V * 0.577350269f};
  foc_duties(foc_inverse_park(v, sinf(ahead_rad), cosf(ahead_rad)), input->bus_V, out);
}

static void foc_motor_tick(void* block, const omnihil_motor_sensors* sensors, omnihil_motor_drive* drive) {
  phase_state* state = block;
  memset(drive, 0, sizeof *drive);
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    phase_wheel* wheel = &state->wheel[w];
    if (wheel->mode == PHASE_OFF || !(sensors->bus_voltage_V > 1.0)) {
      foc_reset(&wheel->foc);
      continue;
    }
    foc_input input;
    memset(&input, 0, sizeof input);
    input.mode = FOC_SPEED;
    for (int x = 0; x < OMNIHIL_LEGS; ++x) input.current_A[x] = (float)sensors->phase_current_A[w][x];
    input.theta_elec_rad = (float)sensors->theta_elec_rad[w];
    input.omega_rotor_rad_s = state->base.encoder[w].omega_rotor_rad_s;
    input.omega_ref_rad_s = wheel->omega_ref_rad_s;
    input.bus_V = (float)sensors->bus_voltage_V;
    input.dt_s = state->period_s;
    /* from the sample to the middle of the period in which the duties act */
    input.delay_s = (1.5f - (float)state->motors.current_sample_ratio) * state->period_s;
    if (wheel->mode == PHASE_VOLTAGE) {
      float duty_ratio[OMNIHIL_LEGS];
      foc_reset(&wheel->foc);
      voltage_along_q(state, &input, wheel->duty_ratio, duty_ratio);
      set_legs(drive, w, duty_ratio);
      continue;
    }
    foc_output output;
    foc_update(&wheel->foc, &state->motor, &state->gains, &input, &output);
    set_legs(drive, w, output.duty_ratio);
    state->base.loop[w].duty_ratio = output.v_q_V * 1.73205081f / input.bus_V; /* for the report */
  }
}

static void six_step_motor_tick(void* block, const omnihil_motor_sensors* sensors,
                                omnihil_motor_drive* drive) {
  phase_state* state = block;
  memset(drive, 0, sizeof *drive);
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    phase_wheel* wheel = &state->wheel[w];
    six_step_input input;
    memset(&input, 0, sizeof input);
    input.mode = SIX_STEP_DUTY;
    input.hall_code = (int)sensors->hall_code[w];
    input.duty_ratio = wheel->duty_ratio;
    input.bus_V = (float)sensors->bus_voltage_V;
    input.dt_s = state->period_s;
    six_step_output output;
    six_step_update(&wheel->six_step, &state->six_step, &input, &output);
    if (wheel->mode == PHASE_OFF) continue;
    for (int x = 0; x < OMNIHIL_LEGS; ++x) {
      if (output.leg[x] == SIX_STEP_LEG_OFF) continue;
      drive->leg[w][x] = OMNIHIL_LEG_PWM;
      if (output.leg[x] == SIX_STEP_LEG_PWM) drive->leg_duty_ratio[w][x] = (double)output.duty_ratio;
    }
  }
}

static void command(void* block, const omnihil_command* wanted, uint64_t now_us) {
  omnihil_reference_firmware()->command(block, wanted, now_us);
}

static void radio_receive(void* block, const uint8_t* bytes, size_t count, uint64_t now_us) {
  omnihil_reference_firmware()->radio_receive(block, bytes, count, now_us);
}

static size_t radio_transmit(void* block, uint8_t* bytes, size_t capacity) {
  return omnihil_reference_firmware()->radio_transmit(block, bytes, capacity);
}

static int set_gains(void* block, const omnihil_gains* gains) {
  return omnihil_reference_firmware()->set_gains(block, gains);
}

static void get_gains(const void* block, omnihil_gains* gains) {
  omnihil_reference_firmware()->get_gains(block, gains);
}

/* Wheel gains of a robot with three-phase drives are those of the speed loop in amperes. */
static int foc_set_gains(void* block, const omnihil_gains* gains) {
  phase_state* state = block;
  if (!state->ready) return set_gains(block, gains);
  omnihil_gains rest = *gains;
  omnihil_gains own;
  get_gains(block, &own);
  if (!isfinite(gains->p[LOOP_WHEELS]) || gains->p[LOOP_WHEELS] < 0.0) return 1;
  if (!isfinite(gains->i[LOOP_WHEELS]) || gains->i[LOOP_WHEELS] < 0.0) return 1;
  rest.p[LOOP_WHEELS] = own.p[LOOP_WHEELS];
  rest.i[LOOP_WHEELS] = own.i[LOOP_WHEELS];
  rest.d[LOOP_WHEELS] = own.d[LOOP_WHEELS];
  int refused = set_gains(block, &rest);
  if (refused != 0) return refused;
  state->gains.speed_p_A_s_per_rad = (float)gains->p[LOOP_WHEELS];
  state->gains.speed_i_A_per_rad = (float)gains->i[LOOP_WHEELS];
  return 0;
}

static void foc_get_gains(const void* block, omnihil_gains* gains) {
  const phase_state* state = block;
  get_gains(block, gains);
  if (!state->ready) return;
  gains->p[LOOP_WHEELS] = (double)state->gains.speed_p_A_s_per_rad;
  gains->i[LOOP_WHEELS] = (double)state->gains.speed_i_A_per_rad;
  gains->d[LOOP_WHEELS] = 0.0;
}

static void feedback(const void* block, omnihil_feedback* report) {
  omnihil_reference_firmware()->feedback(block, report);
}

static const omnihil_firmware_api kFoc = {
    .abi_version = OMNIHIL_FIRMWARE_ABI,
    .struct_bytes = sizeof(omnihil_firmware_api),
    .name = "omnihil reference field-oriented controller",
    .radio_format = "ulaval-hermes",
    .control_period_us = REFERENCE_PERIOD_US,
    .state_bytes = sizeof(phase_state),
    .init = init,
    .command = command,
    .radio_receive = radio_receive,
    .radio_transmit = radio_transmit,
    .set_gains = foc_set_gains,
    .get_gains = foc_get_gains,
    .tick = foc_tick,
    .feedback = feedback,
    .motor_init = motor_init,
    .motor_tick = foc_motor_tick,
};

static const omnihil_firmware_api kSixStep = {
    .abi_version = OMNIHIL_FIRMWARE_ABI,
    .struct_bytes = sizeof(omnihil_firmware_api),
    .name = "omnihil reference six-step controller",
    .radio_format = "ulaval-hermes",
    .control_period_us = REFERENCE_PERIOD_US,
    .state_bytes = sizeof(phase_state),
    .init = init,
    .command = command,
    .radio_receive = radio_receive,
    .radio_transmit = radio_transmit,
    .set_gains = set_gains,
    .get_gains = get_gains,
    .tick = six_step_tick,
    .feedback = feedback,
    .motor_init = motor_init,
    .motor_tick = six_step_motor_tick,
};

const omnihil_firmware_api* omnihil_foc_firmware(void) { return &kFoc; }
const omnihil_firmware_api* omnihil_six_step_firmware(void) { return &kSixStep; }
