#include "firmware_iface/reference/wheel_node.h"

#include <math.h>
#include <string.h>

#include "radio/ulaval_hermes.h"

static const float kPeriod_s = WHEEL_NODE_PERIOD_US * 1e-6f;
static const float kPlan_s = WHEEL_NODE_PERIOD_US * WHEEL_NODE_PERIODS_PER_PLAN * 1e-6f;
static const float kBusLow_V = 1.0f; /* below it a duty for a voltage makes no sense */
static const float kStandstillRim_m_s = 0.02f;

int wheel_node_init(wheel_node* node, const omnihil_robot_config* config, uint8_t wheel) {
  memset(node, 0, sizeof *node);
  if (wheel >= OMNIHIL_WHEELS || wheel_geometry_init(&node->geometry, config) != 0) return 1;
  node->wheel = wheel;
  wheel_tuning_init(&node->tuning, config, kPeriod_s);
  command_watchdog_init(&node->watchdog, config->command_timeout_s);
  hermes_radio_init(&node->radio, config->robot_id);
  node->main.bus_V = (float)config->bus_voltage_nominal_V;
  return 0;
}

static void take_body(wheel_node* node, float x_m_s, float y_m_s, float omega_rad_s) {
  node->body[BODY_X] = x_m_s;
  node->body[BODY_Y] = y_m_s;
  node->body[BODY_OMEGA] = omega_rad_s;
  node->open_loop = 0;
  command_watchdog_feed(&node->watchdog, node->main.now_us);
}

static int take_duty(wheel_node* node, float duty_ratio) {
  if (!(fabsf(duty_ratio) <= 1.0f)) return 1;
  node->duty_ratio = duty_ratio;
  node->open_loop = 1;
  command_watchdog_feed(&node->watchdog, node->main.now_us);
  return 0;
}

static void answer(wheel_node* node, uint32_t type) {
  if (node->wheel != 0) return; /* one voice for the robot */
  float tenths = node->main.bus_V * 10.0f;
  uint32_t decivolts = tenths < 0.0f ? 0u : tenths > 255.0f ? 255u : (uint32_t)tenths;
  hermes_radio_answer(&node->radio, type, type == ULAVAL_HERMES_BATTERIE_RESPONSE_TYPE ? decivolts : 0u);
}

void wheel_node_byte(wheel_node* node, uint8_t byte) {
  hermes_message message;
  if (!hermes_radio_byte(&node->radio, byte, &message)) return;
  switch (message.type) {
    case ULAVAL_HERMES_SPEED_MOVE_TYPE:
    case ULAVAL_HERMES_SPEED_MOVE_ADVANCE_TYPE:
      take_body(node, message.vx_m_s, message.vy_m_s, message.vtheta_rad_s);
      break;
    case ULAVAL_HERMES_OPEN_LOOP_COMMAND_TYPE:
      take_duty(node, message.duty_ratio[node->wheel]);
      break;
    case ULAVAL_HERMES_PING_REQUEST_TYPE:
      answer(node, ULAVAL_HERMES_PING_RESPONSE_TYPE);
      break;
    case ULAVAL_HERMES_GET_BATTERIE_TYPE:
      answer(node, ULAVAL_HERMES_BATTERIE_RESPONSE_TYPE);
      break;
    default:
      break;
  }
}

int wheel_node_command(wheel_node* node, const omnihil_command* command) {
  float wheels[OMNIHIL_WHEELS], body[BODY_AXES];
  switch (command->mode) {
    case OMNIHIL_MODE_BODY_VELOCITY:
      take_body(node, (float)command->v_forward_m_s, (float)command->v_left_m_s,
                (float)command->omega_body_rad_s);
      return 0;
    case OMNIHIL_MODE_WHEEL_SPEED: /* the body velocity that comes nearest */
      for (int w = 0; w < OMNIHIL_WHEELS; ++w) wheels[w] = (float)command->omega_wheel_rad_s[w];
      wheels_to_body(&node->geometry, wheels, body);
      take_body(node, body[BODY_X], body[BODY_Y], body[BODY_OMEGA]);
      return 0;
    case OMNIHIL_MODE_WHEEL_DUTY:
      return take_duty(node, (float)command->duty_ratio[node->wheel]);
    default: /* coast */
      node->watchdog.phase = LINK_SILENT;
      return 0;
  }
}

/* Off, and the next motion starts from rest. */
static void let_go(wheel_node* node) {
  const float still[OMNIHIL_WHEELS] = {0.0f, 0.0f, 0.0f, 0.0f};
  motion_start(&node->motion, &node->geometry, still);
  node->following = 0;
}

static int at_rest(const wheel_node* node) {
  float limit_rad_s = kStandstillRim_m_s / node->geometry.wheel_radius_m * node->tuning.gear_ratio;
  return motion_is_rest(&node->motion) && fabsf(node->main.omega_rotor_rad_s) <= limit_rad_s;
}

/* The torque that the planned acceleration needs at this rotor: tau = r F / gear + J_free d(omega)/dt. */
static float feedforward_Nm(const wheel_node* node) {
  const wheel_tuning* tuning = &node->tuning;
  const motion_reference* motion = &node->motion;
  const wheel_geometry* geometry = &node->geometry;
  uint8_t w = node->wheel;
  float force_N =
      geometry->body_per_rim[BODY_X][w] * tuning->mass_kg * motion->body_accel[BODY_X] +
      geometry->body_per_rim[BODY_Y][w] * tuning->mass_kg * motion->body_accel[BODY_Y] +
      geometry->body_per_rim[BODY_OMEGA][w] * tuning->yaw_inertia_kg_m2 * motion->body_accel[BODY_OMEGA];
  return force_N * geometry->wheel_radius_m / tuning->gear_ratio +
         tuning->inertia_free_kg_m2 * motion->wheel_accel_rad_s2[w] * tuning->gear_ratio;
}

void wheel_node_plan(wheel_node* node) {
  const float rest[BODY_AXES] = {0.0f, 0.0f, 0.0f};
  wheel_plan* next = &node->next;
  node->main = node->seen;
  link_phase phase = command_watchdog_update(&node->watchdog, node->main.now_us,
                                             node->following || node->open_loop, at_rest(node));
  memset(next, 0, sizeof *next);
  if (phase == LINK_SILENT || node->main.bus_V < kBusLow_V) {
    let_go(node);
  } else if (node->open_loop && phase == LINK_LIVE) {
    let_go(node);
    next->on = next->open_loop = 1;
    next->duty_ratio = node->duty_ratio;
  } else {
    motion_reference* motion = &node->motion;
    motion->wheel_limit_rad_s =
        0.95f * node->main.bus_V / node->tuning.motor.torque_constant_Nm_per_A / node->tuning.gear_ratio;
    motion_toward_body(motion, &node->geometry, phase == LINK_STOPPING ? rest : node->body, kPlan_s);
    node->following = 1;
    next->on = 1;
    next->omega_rotor_rad_s = motion->omega_wheel_rad_s[node->wheel] * node->tuning.gear_ratio;
    next->torque_rotor_Nm = feedforward_Nm(node);
  }
  node->plan_due = 0;
}

/* At a plan's end: the one that the main loop has made meanwhile. Late: the old one's end is held. */
static void turn_to_next(wheel_node* node, float bus_V) {
  if (node->until_plan > 0) {
    --node->until_plan;
    return;
  }
  node->until_plan = WHEEL_NODE_PERIODS_PER_PLAN - 1;
  if (node->plan_due) {
    node->plan.torque_rotor_Nm = node->omega_rotor_step_rad_s = 0.0f;
    return;
  }
  node->plan = node->next;
  if (!node->plan.on) node->omega_rotor_ref_rad_s = 0.0f;
  node->omega_rotor_step_rad_s =
      (node->plan.omega_rotor_rad_s - node->omega_rotor_ref_rad_s) / WHEEL_NODE_PERIODS_PER_PLAN;
  node->seen.now_us = node->now_us;
  node->seen.bus_V = bus_V;
  node->seen.omega_rotor_rad_s = node->encoder.omega_rotor_reported_rad_s;
  node->plan_due = 1;
}

wheel_node_drive wheel_node_control(wheel_node* node, int64_t counts, float bus_V) {
  node->now_us += WHEEL_NODE_PERIOD_US;
  wheel_encoder_update(&node->encoder, &node->tuning.encoder, counts, kPeriod_s);
  turn_to_next(node, bus_V);
  node->omega_rotor_ref_rad_s += node->omega_rotor_step_rad_s;
  node->drive.on = node->plan.on && !wheel_encoder_faulty(&node->encoder);
  if (!node->drive.on || node->plan.open_loop) {
    wheel_loop_reset(&node->loop);
    node->drive.duty_ratio = node->drive.on ? node->plan.duty_ratio : 0.0f;
    return node->drive;
  }
  const wheel_loop_input input = {.omega_ref_rad_s = node->omega_rotor_ref_rad_s,
                                  .omega_rad_s = node->encoder.omega_rotor_rad_s,
                                  .accel_rad_s2 = node->encoder.accel_rotor_rad_s2,
                                  .torque_feedforward_Nm = node->plan.torque_rotor_Nm,
                                  .bus_V = bus_V,
                                  .dt_s = kPeriod_s};
  node->drive.duty_ratio = wheel_loop_update(&node->loop, &node->tuning.gains, &node->tuning.motor, &input);
  return node->drive;
}
