#include "firmware_iface/reference/hermes_robot.h"

#include <string.h>

#include "firmware_iface/reference/reference_firmware.h"
#include "radio/ulaval_hermes.h"

enum { REGISTER_LOOP = 0, REGISTER_KICK = 1, REGISTER_CHARGE = 2, REGISTER_DRIBBLER = 3 };

static const uint64_t kKickWait_us = 10000000u;
static const uint64_t kChargeTime_us = 60000000u;
static const double kDribblerDuty[] = {0.0, 0.1, 0.2, 0.35};
static const float kKickTick_s = 1.0e-4f;
static const float kKickRegister_s = 1.0e-3f;

static double dribbler_duty(uint32_t level) {
  return level < sizeof kDribblerDuty / sizeof kDribblerDuty[0] ? kDribblerDuty[level] : 0.0;
}

void hermes_robot_init(hermes_robot* robot) {
  memset(robot, 0, sizeof *robot);
  robot->loop = HERMES_CLOSED;
  robot->command[HERMES_CLOSED].mode = OMNIHIL_MODE_BODY_VELOCITY;
  robot->command[HERMES_OPEN].mode = OMNIHIL_MODE_WHEEL_DUTY;
}

/* Puts the loop's last packet in force, with the age it has. */
static void apply(reference_state* state, uint32_t loop) {
  hermes_robot* hermes = &state->hermes;
  if (hermes->loop != loop) return;
  if (!hermes->received[loop]) {
    const omnihil_command coast = {.mode = OMNIHIL_MODE_COAST};
    state->command = coast;
    return;
  }
  reference_take_motion(state, &hermes->command[loop], hermes->received_us[loop]);
}

static void take(reference_state* state, uint32_t loop, uint64_t now_us) {
  state->hermes.received[loop] = 1;
  state->hermes.received_us[loop] = now_us;
  apply(state, loop);
}

static void move(reference_state* state, const hermes_message* message, uint64_t now_us) {
  omnihil_command* command = &state->hermes.command[HERMES_CLOSED];
  command->v_forward_m_s = (double)message->vx_m_s;
  command->v_left_m_s = (double)message->vy_m_s;
  command->omega_body_rad_s = (double)message->vtheta_rad_s;
  if (message->type == ULAVAL_HERMES_SPEED_MOVE_ADVANCE_TYPE) {
    command->dribbler_ratio = dribbler_duty(message->dribbler);
    if (message->charge) kicker_charge(&state->kick, now_us + kChargeTime_us);
    if (message->kick_force > 0) {
      kicker_charge(&state->kick, now_us + kChargeTime_us);
      kicker_arm(&state->kick, OMNIHIL_KICK_STRAIGHT, OMNIHIL_KICK_ON_BALL,
                 kKickTick_s * (float)message->kick_force, now_us + kKickWait_us);
    }
  }
  take(state, HERMES_CLOSED, now_us);
}

static void move_open(reference_state* state, const hermes_message* message, uint64_t now_us) {
  omnihil_command wanted = state->hermes.command[HERMES_OPEN];
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    wanted.duty_ratio[w] = (double)message->duty_ratio[w];
    if (wanted.duty_ratio[w] < -1.0 || wanted.duty_ratio[w] > 1.0) {
      ++state->commands_refused;
      return;
    }
  }
  state->hermes.command[HERMES_OPEN] = wanted;
  take(state, HERMES_OPEN, now_us);
}

static void set_register(reference_state* state, const hermes_message* message, uint64_t now_us) {
  hermes_robot* hermes = &state->hermes;
  if (message->register_id == REGISTER_LOOP && message->value <= 2) {
    hermes->loop = message->value == 0 ? HERMES_OPEN : HERMES_CLOSED;
    apply(state, hermes->loop);
  } else if (message->register_id == REGISTER_KICK) {
    kicker_charge(&state->kick, now_us + kChargeTime_us);
    kicker_arm(&state->kick, OMNIHIL_KICK_STRAIGHT, OMNIHIL_KICK_ON_BALL,
               kKickRegister_s * (float)message->value, now_us + kKickWait_us);
  } else if (message->register_id == REGISTER_CHARGE) {
    kicker_charge(&state->kick, now_us + kChargeTime_us);
  } else if (message->register_id == REGISTER_DRIBBLER) {
    double duty = dribbler_duty(message->value);
    hermes->command[HERMES_CLOSED].dribbler_ratio = duty;
    hermes->command[HERMES_OPEN].dribbler_ratio = duty;
    state->command.dribbler_ratio = duty;
  } else {
    ++hermes->registers_unknown;
  }
}

static uint32_t decivolts(float battery_V) {
  float tenths = battery_V * 10.0f;
  return tenths < 0.0f ? 0u : tenths > 255.0f ? 255u : (uint32_t)tenths; /* theirs cuts off, too */
}

void hermes_robot_act(reference_state* state, const hermes_message* message, uint64_t now_us) {
  if (message->type != ULAVAL_HERMES_GET_NUM_REQUEST_TYPE) ++state->hermes.packets;
  switch (message->type) {
    case ULAVAL_HERMES_SPEED_MOVE_TYPE:
    case ULAVAL_HERMES_SPEED_MOVE_ADVANCE_TYPE:
      move(state, message, now_us);
      break;
    case ULAVAL_HERMES_OPEN_LOOP_COMMAND_TYPE:
      move_open(state, message, now_us);
      break;
    case ULAVAL_HERMES_SET_REGISTER_TYPE:
      set_register(state, message, now_us);
      break;
    case ULAVAL_HERMES_PING_REQUEST_TYPE:
      hermes_radio_answer(&state->radio, ULAVAL_HERMES_PING_RESPONSE_TYPE, 0);
      break;
    case ULAVAL_HERMES_GET_BATTERIE_TYPE:
      hermes_radio_answer(&state->radio, ULAVAL_HERMES_BATTERIE_RESPONSE_TYPE, decivolts(state->battery_V));
      break;
    case ULAVAL_HERMES_GET_NUM_REQUEST_TYPE:
      hermes_radio_answer(&state->radio, ULAVAL_HERMES_NUM_REQUEST_RESPONSE_TYPE, state->hermes.packets);
      break;
    default:
      break;
  }
}
