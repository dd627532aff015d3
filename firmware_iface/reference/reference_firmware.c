#include "firmware_iface/reference/reference_firmware.h"

#include <math.h>
#include <string.h>

static const double kYawGain_per_s = 5.0; /* 1/0.2 s; times 8 rad/s stays below the yaw acceleration limit */
static const double kLongestTimeout_s = 3600.0;

static int check_config(const omnihil_robot_config* config) {
  const double positive[] = {config->wheel_radius_m,
                             config->wheel_center_radius_m,
                             config->gear_ratio,
                             fabs(config->encoder_counts_per_rotor_turn),
                             config->bus_voltage_nominal_V,
                             config->motor_resistance_ohm,
                             config->motor_torque_constant_Nm_per_A};
  for (size_t i = 0; i < sizeof positive / sizeof positive[0]; ++i) {
    if (!isfinite(positive[i])) return REFERENCE_CONFIG_NOT_FINITE;
    if (positive[i] <= 0.0) return REFERENCE_CONFIG_NOT_POSITIVE;
  }
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    if (!isfinite(config->wheel_angle_rad[w])) return REFERENCE_CONFIG_NOT_FINITE;
  }
  if (!isfinite(config->command_timeout_s)) return REFERENCE_CONFIG_NOT_FINITE;
  if (config->command_timeout_s < 0.0 || config->command_timeout_s > kLongestTimeout_s) {
    return REFERENCE_CONFIG_TIMEOUT;
  }
  return REFERENCE_CONFIG_OK;
}

static int init(void* block, const omnihil_robot_config* config) {
  reference_state* state = block;
  int refusal = check_config(config);
  if (refusal != REFERENCE_CONFIG_OK) return refusal;
  memset(state, 0, sizeof *state);
  state->config = *config;
  if (wheel_geometry_init(&state->geometry, config) != 0) return REFERENCE_CONFIG_WHEELS;
  wheel_tuning_init(&state->tuning, config, REFERENCE_PERIOD_US * 1e-6f);
  command_watchdog_init(&state->watchdog, config->command_timeout_s);
  hermes_radio_init(&state->radio, config->robot_id);
  hermes_robot_init(&state->hermes);
  state->bus_V = (float)config->bus_voltage_nominal_V;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) belbic_reset(&state->emotion[w]);
  state->gains.p[LOOP_YAW] = kYawGain_per_s;
  state->gains.p[LOOP_WHEELS] = (double)state->tuning.gains.p_V_s_per_rad;
  state->gains.i[LOOP_WHEELS] = (double)state->tuning.gains.i_V_per_rad;
  state->gains.d[LOOP_WHEELS] = (double)state->tuning.gains.d_V_s2_per_rad;
  return REFERENCE_CONFIG_OK;
}

static void command(void* block, const omnihil_command* wanted, uint64_t now_us) {
  reference_take_command(block, wanted, now_us);
}

static void radio_receive(void* block, const uint8_t* bytes, size_t count, uint64_t now_us) {
  reference_state* state = block;
  for (size_t i = 0; i < count; ++i) {
    hermes_message message;
    if (hermes_radio_byte(&state->radio, bytes[i], &message)) hermes_robot_act(state, &message, now_us);
  }
}

static size_t radio_transmit(void* block, uint8_t* bytes, size_t capacity) {
  reference_state* state = block;
  return hermes_radio_transmit(&state->radio, bytes, capacity);
}

static int set_gains(void* block, const omnihil_gains* gains) {
  reference_state* state = block;
  for (int loop = 0; loop < OMNIHIL_LOOPS; ++loop) {
    const double all[] = {gains->p[loop], gains->i[loop], gains->d[loop], gains->d2[loop]};
    for (size_t g = 0; g < sizeof all / sizeof all[0]; ++g) {
      if (!isfinite(all[g]) || all[g] < 0.0) return 1;
    }
  }
  state->gains = *gains;
  state->tuning.gains.p_V_s_per_rad = (float)gains->p[LOOP_WHEELS];
  state->tuning.gains.i_V_per_rad = (float)gains->i[LOOP_WHEELS];
  state->tuning.gains.d_V_s2_per_rad = (float)gains->d[LOOP_WHEELS];
  return 0;
}

static void get_gains(const void* block, omnihil_gains* gains) {
  const reference_state* state = block;
  *gains = state->gains;
}

static void tick(void* block, const omnihil_sensors* sensors, omnihil_drive* drive) {
  reference_state* state = block;
  if (state->command.flags & OMNIHIL_COMMAND_REBOOT) {
    omnihil_robot_config config = state->config;
    uint32_t emotional = state->emotional;
    init(state, &config);
    state->emotional = emotional;
  }
  reference_tick(state, sensors, drive);
}

static void feedback(const void* block, omnihil_feedback* report) { reference_feedback(block, report); }

static const omnihil_firmware_api kApi = {
    .abi_version = OMNIHIL_FIRMWARE_ABI,
    .struct_bytes = sizeof(omnihil_firmware_api),
    .name = "omnihil reference wheel controller",
    .radio_format = "ulaval-hermes",
    .control_period_us = REFERENCE_PERIOD_US,
    .state_bytes = sizeof(reference_state),
    .init = init,
    .command = command,
    .radio_receive = radio_receive,
    .radio_transmit = radio_transmit,
    .set_gains = set_gains,
    .get_gains = get_gains,
    .tick = tick,
    .feedback = feedback,
};

static int emotional_init(void* block, const omnihil_robot_config* config) {
  int refusal = init(block, config);
  if (refusal == REFERENCE_CONFIG_OK) ((reference_state*)block)->emotional = 1;
  return refusal;
}

static const omnihil_firmware_api kEmotional = {
    .abi_version = OMNIHIL_FIRMWARE_ABI,
    .struct_bytes = sizeof(omnihil_firmware_api),
    .name = "omnihil reference emotional controller",
    .radio_format = "ulaval-hermes",
    .control_period_us = REFERENCE_PERIOD_US,
    .state_bytes = sizeof(reference_state),
    .init = emotional_init,
    .command = command,
    .radio_receive = radio_receive,
    .radio_transmit = radio_transmit,
    .set_gains = set_gains,
    .get_gains = get_gains,
    .tick = tick,
    .feedback = feedback,
};

const omnihil_firmware_api* omnihil_reference_firmware(void) { return &kApi; }
const omnihil_firmware_api* omnihil_emotional_firmware(void) { return &kEmotional; }

const omnihil_firmware_api* omnihil_firmware_get(uint32_t abi_version) {
  return abi_version == OMNIHIL_FIRMWARE_ABI ? &kApi : NULL;
}
