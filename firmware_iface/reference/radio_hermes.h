/* Radio format "ulaval-hermes" at the robot's end: bytes from the air in, checked packets out, and answers.
 *
 *   if (hermes_radio_byte(&radio, byte, &message)) …      // for each byte of the air; message is checked
 *
 * Wire: COBS(header 5 + payload), then 00. A frame that fails a check is counted under its cause and dropped
 * whole; the next 00 brings the receiver back in step. Checks, in this order: stuffing, length, version,
 * type, length of the type, checksum, source or direction, finite floats, address. Field places come from the
 * table of protocols/teams/ulaval_hermes.cc, through a header made from it.
 */
#ifndef OMNIHIL_REFERENCE_RADIO_HERMES_H
#define OMNIHIL_REFERENCE_RADIO_HERMES_H
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { HERMES_LONGEST = 21, HERMES_ANSWERS = 4, HERMES_ANSWER_BYTES = 11 };

typedef enum hermes_refusal {
  HERMES_TOO_SHORT,
  HERMES_TOO_LONG,
  HERMES_FRAMING,
  HERMES_CHECKSUM,
  HERMES_VERSION,
  HERMES_UNKNOWN_TYPE,
  HERMES_SOURCE,    /* does not come from the host's address */
  HERMES_DIRECTION, /* an answer, which only robots send */
  HERMES_NOT_FINITE,
  HERMES_ADDRESS, /* for another robot */
  HERMES_OVERRUN, /* an answer that found the queue full */
  HERMES_REFUSALS
} hermes_refusal;

typedef struct hermes_message {
  uint32_t type; /* ULAVAL_HERMES_*_TYPE */
  float vx_m_s;  /* SPEED_MOVE, SPEED_MOVE_ADVANCE */
  float vy_m_s;
  float vtheta_rad_s;
  float duty_ratio[4];  /* OPEN_LOOP_COMMAND */
  uint32_t register_id; /* SET_REGISTER */
  uint32_t value;
  uint32_t dribbler; /* SPEED_MOVE_ADVANCE */
  uint32_t charge;
  uint32_t kick_force; /* 0.1 ms */
} hermes_message;

typedef struct hermes_radio {
  uint32_t robot_id;
  uint32_t accepted;
  uint32_t refused[HERMES_REFUSALS];
  /* the frame that is coming in */
  uint8_t packet[HERMES_LONGEST];
  uint32_t size;
  uint32_t block_left; /* bytes until the next code byte */
  uint32_t zero_due;   /* the block stands for a zero after it */
  uint32_t started;
  uint32_t overflow; /* 1 in this block, 2 in an earlier one */
  /* answers waiting */
  uint8_t answer[HERMES_ANSWERS][HERMES_ANSWER_BYTES];
  uint32_t answer_size[HERMES_ANSWERS];
  uint32_t answer_first;
  uint32_t answer_count;
} hermes_radio;

void hermes_radio_init(hermes_radio* radio, uint32_t robot_id);
/* 1 when this byte completed a packet for this robot. */
int hermes_radio_byte(hermes_radio* radio, uint8_t byte, hermes_message* message);
/* Queues an answer; `value` fills its payload, if it has one. */
void hermes_radio_answer(hermes_radio* radio, uint32_t type, uint32_t value);
size_t hermes_radio_transmit(hermes_radio* radio, uint8_t* bytes, size_t capacity);

#ifdef __cplusplus
}
#endif
#endif
