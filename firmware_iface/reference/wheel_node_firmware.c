#include "firmware_iface/reference/wheel_node_firmware.h"

#include <string.h>

#include "firmware_iface/reference/reference_firmware.h"
#include "firmware_iface/reference/wheel_node.h"

typedef struct {
  wheel_node node[OMNIHIL_WHEELS];
  omnihil_gains gains;
  float gear_ratio;
  uint64_t now_us;
} robot_state;

static int init(void* block, const omnihil_robot_config* config) {
  robot_state* state = block;
  memset(state, 0, sizeof *state);
  for (uint8_t w = 0; w < OMNIHIL_WHEELS; ++w) {
    if (wheel_node_init(&state->node[w], config, w) != 0) return REFERENCE_CONFIG_WHEELS;
  }
  const wheel_tuning* tuning = &state->node[0].tuning;
  state->gear_ratio = tuning->gear_ratio;
  state->gains.p[LOOP_WHEELS] = (double)tuning->gains.p_V_s_per_rad;
  state->gains.i[LOOP_WHEELS] = (double)tuning->gains.i_V_per_rad;
  return 0;
}

static void command(void* block, const omnihil_command* wanted, uint64_t now_us) {
  robot_state* state = block;
  (void)now_us; /* a board keeps its own time */
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) wheel_node_command(&state->node[w], wanted);
}

static void radio_receive(void* block, const uint8_t* bytes, size_t count, uint64_t now_us) {
  robot_state* state = block;
  (void)now_us;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    for (size_t i = 0; i < count; ++i) wheel_node_byte(&state->node[w], bytes[i]);
  }
}

static size_t radio_transmit(void* block, uint8_t* bytes, size_t capacity) {
  robot_state* state = block;
  return hermes_radio_transmit(&state->node[0].radio, bytes, capacity);
}

static int set_gains(void* block, const omnihil_gains* gains) {
  (void)block, (void)gains;
  return 1; /* these come from the configuration alone */
}

static void get_gains(const void* block, omnihil_gains* gains) {
  const robot_state* state = block;
  *gains = state->gains;
}

static void tick(void* block, const omnihil_sensors* sensors, omnihil_drive* drive) {
  robot_state* state = block;
  state->now_us = sensors->now_us;
  memset(drive, 0, sizeof *drive);
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    wheel_node* node = &state->node[w];
    wheel_node_drive wanted =
        wheel_node_control(node, sensors->encoder_counts[w], (float)sensors->bus_voltage_V);
    if (node->plan_due) wheel_node_plan(node);
    drive->mode[w] = wanted.on ? OMNIHIL_DRIVE_DUTY : OMNIHIL_DRIVE_COAST;
    drive->duty_ratio[w] = (double)wanted.duty_ratio;
  }
}

static void feedback(const void* block, omnihil_feedback* report) {
  const robot_state* state = block;
  memset(report, 0, sizeof *report);
  report->now_us = state->now_us;
  report->battery_V = (double)state->node[0].main.bus_V;
  if (state->node[0].watchdog.phase != LINK_LIVE) report->flags |= OMNIHIL_FEEDBACK_COMMAND_TIMEOUT;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    report->omega_wheel_rad_s[w] =
        (double)(state->node[w].encoder.omega_rotor_reported_rad_s / state->gear_ratio);
    report->duty_ratio[w] = (double)state->node[w].drive.duty_ratio;
  }
}

static const omnihil_firmware_api kApi = {
    .abi_version = OMNIHIL_FIRMWARE_ABI,
    .struct_bytes = sizeof(omnihil_firmware_api),
    .name = "omnihil reference wheel nodes",
    .radio_format = "ulaval-hermes",
    .control_period_us = WHEEL_NODE_PERIOD_US,
    .state_bytes = sizeof(robot_state),
    .init = init,
    .command = command,
    .radio_receive = radio_receive,
    .radio_transmit = radio_transmit,
    .set_gains = set_gains,
    .get_gains = get_gains,
    .tick = tick,
    .feedback = feedback,
};

const omnihil_firmware_api* omnihil_wheel_node_firmware(void) { return &kApi; }
