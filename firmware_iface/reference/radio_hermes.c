#include "firmware_iface/reference/radio_hermes.h"

#include <math.h>
#include <string.h>

#include "radio/ulaval_hermes.h"

#define PLACE(message, field) \
  ULAVAL_HERMES_##message##_##field##_BIT, ULAVAL_HERMES_##message##_##field##_BITS

enum { HEADER_BYTES = ULAVAL_HERMES_PING_REQUEST_BYTES };

static const uint8_t kBytesOfType[] = {
    [ULAVAL_HERMES_PING_REQUEST_TYPE] = ULAVAL_HERMES_PING_REQUEST_BYTES,
    [ULAVAL_HERMES_PING_RESPONSE_TYPE] = ULAVAL_HERMES_PING_RESPONSE_BYTES,
    [ULAVAL_HERMES_SPEED_MOVE_TYPE] = ULAVAL_HERMES_SPEED_MOVE_BYTES,
    [ULAVAL_HERMES_SET_REGISTER_TYPE] = ULAVAL_HERMES_SET_REGISTER_BYTES,
    [ULAVAL_HERMES_OPEN_LOOP_COMMAND_TYPE] = ULAVAL_HERMES_OPEN_LOOP_COMMAND_BYTES,
    [ULAVAL_HERMES_GET_BATTERIE_TYPE] = ULAVAL_HERMES_GET_BATTERIE_BYTES,
    [ULAVAL_HERMES_BATTERIE_RESPONSE_TYPE] = ULAVAL_HERMES_BATTERIE_RESPONSE_BYTES,
    [ULAVAL_HERMES_GET_NUM_REQUEST_TYPE] = ULAVAL_HERMES_GET_NUM_REQUEST_BYTES,
    [ULAVAL_HERMES_NUM_REQUEST_RESPONSE_TYPE] = ULAVAL_HERMES_NUM_REQUEST_RESPONSE_BYTES,
    [ULAVAL_HERMES_SPEED_MOVE_ADVANCE_TYPE] = ULAVAL_HERMES_SPEED_MOVE_ADVANCE_BYTES,
};
_Static_assert(HERMES_LONGEST == ULAVAL_HERMES_OPEN_LOOP_COMMAND_BYTES, "room for the longest packet");
/* stuffing adds one byte, the delimiter another */
_Static_assert(HERMES_ANSWER_BYTES == ULAVAL_HERMES_NUM_REQUEST_RESPONSE_BYTES + 2, "room for an answer");

/* Bits `bit` to `bit + bits - 1`, bit 0 the least significant of byte 0. */
static uint32_t get_bits(const uint8_t* packet, unsigned bit, unsigned bits) {
  uint32_t value = 0;
  for (unsigned i = 0; i < bits; ++i) {
    value |= (uint32_t)(packet[(bit + i) / 8] >> ((bit + i) % 8) & 1u) << i;
  }
  return value;
}

static void set_bits(uint8_t* packet, unsigned bit, unsigned bits, uint32_t value) {
  for (unsigned i = 0; i < bits; ++i) {
    if (value >> i & 1u) packet[(bit + i) / 8] |= (uint8_t)(1u << ((bit + i) % 8));
  }
}

static float get_float(const uint8_t* packet, unsigned bit, unsigned bits) {
  uint32_t raw = get_bits(packet, bit, bits);
  float value;
  memcpy(&value, &raw, sizeof value);
  return value;
}

/* Sum of all bytes but the checksum itself, modulo 256. */
static uint32_t checksum_of(const uint8_t* packet, size_t size) {
  uint32_t sum = 0;
  for (size_t i = 0; i < size; ++i) sum += packet[i];
  return (sum - get_bits(packet, PLACE(PING_REQUEST, CHECKSUM))) & 0xFFu;
}

static int is_answer(uint32_t type) {
  return type == ULAVAL_HERMES_PING_RESPONSE_TYPE || type == ULAVAL_HERMES_BATTERIE_RESPONSE_TYPE ||
         type == ULAVAL_HERMES_NUM_REQUEST_RESPONSE_TYPE;
}

static int finite_speed(const hermes_message* m) {
  return isfinite(m->vx_m_s) && isfinite(m->vy_m_s) && isfinite(m->vtheta_rad_s);
}

/* The payload's fields; 0 when a float is not finite. */
static int read_fields(const uint8_t* packet, hermes_message* m) {
  switch (m->type) {
    case ULAVAL_HERMES_SPEED_MOVE_TYPE:
      m->vx_m_s = get_float(packet, PLACE(SPEED_MOVE, VX));
      m->vy_m_s = get_float(packet, PLACE(SPEED_MOVE, VY));
      m->vtheta_rad_s = get_float(packet, PLACE(SPEED_MOVE, VTHETA));
      return finite_speed(m);
    case ULAVAL_HERMES_SPEED_MOVE_ADVANCE_TYPE:
      m->vx_m_s = get_float(packet, PLACE(SPEED_MOVE_ADVANCE, VX));
      m->vy_m_s = get_float(packet, PLACE(SPEED_MOVE_ADVANCE, VY));
      m->vtheta_rad_s = get_float(packet, PLACE(SPEED_MOVE_ADVANCE, VTHETA));
      m->dribbler = get_bits(packet, PLACE(SPEED_MOVE_ADVANCE, DRIBBLER));
      m->charge = get_bits(packet, PLACE(SPEED_MOVE_ADVANCE, CHARGE));
      m->kick_force = get_bits(packet, PLACE(SPEED_MOVE_ADVANCE, KICK_FORCE));
      return finite_speed(m);
    case ULAVAL_HERMES_OPEN_LOOP_COMMAND_TYPE:
      m->duty_ratio[0] = get_float(packet, PLACE(OPEN_LOOP_COMMAND, CMD_0));
      m->duty_ratio[1] = get_float(packet, PLACE(OPEN_LOOP_COMMAND, CMD_1));
      m->duty_ratio[2] = get_float(packet, PLACE(OPEN_LOOP_COMMAND, CMD_2));
      m->duty_ratio[3] = get_float(packet, PLACE(OPEN_LOOP_COMMAND, CMD_3));
      return isfinite(m->duty_ratio[0]) && isfinite(m->duty_ratio[1]) && isfinite(m->duty_ratio[2]) &&
             isfinite(m->duty_ratio[3]);
    case ULAVAL_HERMES_SET_REGISTER_TYPE:
      m->register_id = get_bits(packet, PLACE(SET_REGISTER, REGISTER));
      m->value = get_bits(packet, PLACE(SET_REGISTER, VALUE));
      return 1;
    default:
      return 1;
  }
}

/* HERMES_REFUSALS when the packet is good and for this robot; otherwise why not. */
static hermes_refusal read_packet(const hermes_radio* radio, hermes_message* message) {
  const uint8_t* packet = radio->packet;
  uint32_t size = radio->size;
  if (size < HEADER_BYTES) return HERMES_TOO_SHORT;
  if (get_bits(packet, PLACE(PING_REQUEST, VERSION)) != ULAVAL_HERMES_PING_REQUEST_VERSION_CONST) {
    return HERMES_VERSION;
  }
  memset(message, 0, sizeof *message);
  message->type = get_bits(packet, PLACE(PING_REQUEST, TYPE));
  if (message->type >= sizeof kBytesOfType) return HERMES_UNKNOWN_TYPE;
  if (size < kBytesOfType[message->type]) return HERMES_TOO_SHORT;
  if (size > kBytesOfType[message->type]) return HERMES_TOO_LONG;
  if (checksum_of(packet, size) != get_bits(packet, PLACE(PING_REQUEST, CHECKSUM))) return HERMES_CHECKSUM;
  if (is_answer(message->type)) return HERMES_DIRECTION;
  if (get_bits(packet, PLACE(PING_REQUEST, SOURCE)) != ULAVAL_HERMES_PING_REQUEST_SOURCE_CONST) {
    return HERMES_SOURCE;
  }
  if (!read_fields(packet, message)) return HERMES_NOT_FINITE;
  if (get_bits(packet, PLACE(PING_REQUEST, ROBOT)) != radio->robot_id) return HERMES_ADDRESS;
  return HERMES_REFUSALS;
}

void hermes_radio_init(hermes_radio* radio, uint32_t robot_id) {
  memset(radio, 0, sizeof *radio);
  radio->robot_id = robot_id;
}

static void put(hermes_radio* radio, uint8_t byte) {
  if (radio->size < HERMES_LONGEST) {
    radio->packet[radio->size++] = byte;
  } else if (radio->overflow == 0) {
    radio->overflow = 1;
  }
}

/* Takes the stuffing out, byte by byte: a code n stands before n - 1 bytes and, unless n = FFh or the frame
 * ends there, for a zero after them. */
static void unstuff(hermes_radio* radio, uint8_t byte) {
  radio->started = 1;
  if (radio->block_left > 0) {
    put(radio, byte);
    --radio->block_left;
    return;
  }
  if (radio->zero_due) put(radio, 0);
  if (radio->overflow) radio->overflow = 2;
  radio->block_left = byte - 1u;
  radio->zero_due = byte != 0xFFu;
}

int hermes_radio_byte(hermes_radio* radio, uint8_t byte, hermes_message* message) {
  if (byte != 0) {
    unstuff(radio, byte);
    return 0;
  }
  if (!radio->started) return 0; /* a delimiter after a delimiter: nothing lost */
  hermes_refusal refusal;
  if (radio->overflow == 2 || (radio->overflow == 1 && radio->block_left == 0)) {
    refusal = HERMES_TOO_LONG;
  } else if (radio->block_left > 0) {
    refusal = HERMES_FRAMING;
  } else {
    refusal = read_packet(radio, message);
  }
  radio->size = radio->block_left = radio->zero_due = radio->started = radio->overflow = 0;
  if (refusal != HERMES_REFUSALS) {
    ++radio->refused[refusal];
    return 0;
  }
  ++radio->accepted;
  return 1;
}

static size_t stuff(const uint8_t* packet, size_t size, uint8_t* frame) {
  size_t code_at = 0, end = 1; /* packets are shorter than 254 bytes: no block fills up */
  for (size_t i = 0; i < size; ++i) {
    if (packet[i] != 0) {
      frame[end++] = packet[i];
    } else {
      frame[code_at] = (uint8_t)(end - code_at);
      code_at = end++;
    }
  }
  frame[code_at] = (uint8_t)(end - code_at);
  frame[end++] = 0;
  return end;
}

void hermes_radio_answer(hermes_radio* radio, uint32_t type, uint32_t value) {
  if (radio->answer_count == HERMES_ANSWERS) {
    ++radio->refused[HERMES_OVERRUN];
    return;
  }
  uint8_t packet[ULAVAL_HERMES_NUM_REQUEST_RESPONSE_BYTES] = {0};
  set_bits(packet, PLACE(PING_RESPONSE, VERSION), ULAVAL_HERMES_PING_RESPONSE_VERSION_CONST);
  set_bits(packet, PLACE(PING_RESPONSE, ROBOT), radio->robot_id);
  set_bits(packet, PLACE(PING_RESPONSE, DESTINATION), ULAVAL_HERMES_PING_RESPONSE_DESTINATION_CONST);
  set_bits(packet, PLACE(PING_RESPONSE, TYPE), type);
  if (type == ULAVAL_HERMES_BATTERIE_RESPONSE_TYPE) {
    set_bits(packet, PLACE(BATTERIE_RESPONSE, DECIVOLTS), value);
  } else if (type == ULAVAL_HERMES_NUM_REQUEST_RESPONSE_TYPE) {
    set_bits(packet, PLACE(NUM_REQUEST_RESPONSE, VALUE), value);
  }
  set_bits(packet, PLACE(PING_RESPONSE, CHECKSUM), checksum_of(packet, kBytesOfType[type]));
  uint32_t slot = (radio->answer_first + radio->answer_count++) % HERMES_ANSWERS;
  radio->answer_size[slot] = (uint32_t)stuff(packet, kBytesOfType[type], radio->answer[slot]);
}

size_t hermes_radio_transmit(hermes_radio* radio, uint8_t* bytes, size_t capacity) {
  uint32_t slot = radio->answer_first;
  if (radio->answer_count == 0 || radio->answer_size[slot] > capacity) return 0;
  memcpy(bytes, radio->answer[slot], radio->answer_size[slot]);
  radio->answer_first = (slot + 1) % HERMES_ANSWERS;
  --radio->answer_count;
  return radio->answer_size[slot];
}
