/* What each HERMES packet makes the robot do, as RoboCup ULaval's robots do it (RobotMCU 44cc54f).
 *
 *   SPEED_MOVE, SPEED_MOVE_ADVANCE   body velocity, in force while register 0 says closed loop
 *   OPEN_LOOP_COMMAND                four duties, in force while register 0 says open loop
 *   SET_REGISTER  0 loop             0 open, 1 closed, 2 closed and logged (here the same as 1)
 *                 1 kick             pulse in ms, waits up to 10 s for the ball
 *                 2 charge           for 60 s
 *                 3 dribbler         0 off, 1, 2, 3: duty 0.1, 0.2, 0.35
 *   PING_REQUEST, GET_BATTERIE, GET_NUM_REQUEST   an answer: none, decivolts, packets received so far
 *                                                 (questions for that number not counted)
 *
 * Each loop has its own last packet and its own age: after switching, an old packet does not move the robot.
 * Differences, on purpose: a wrong checksum is refused (theirs logs it and acts); the charge bit does not
 * switch the dribbler off; the dribbler stops with the command timeout instead of after 2 s; duties beyond
 * -1..1 are refused (theirs limits them); no dead zone around zero speed.
 */
#ifndef OMNIHIL_REFERENCE_HERMES_ROBOT_H
#define OMNIHIL_REFERENCE_HERMES_ROBOT_H
#include "firmware_iface/omnihil_firmware.h"
#include "firmware_iface/reference/radio_hermes.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { HERMES_CLOSED = 0, HERMES_OPEN = 1, HERMES_LOOPS = 2 };

typedef struct hermes_robot {
  uint32_t loop;                         /* HERMES_CLOSED or HERMES_OPEN */
  omnihil_command command[HERMES_LOOPS]; /* last packet of each kind */
  uint64_t received_us[HERMES_LOOPS];
  uint32_t received[HERMES_LOOPS];
  uint32_t packets;           /* so far; GET_NUM_REQUEST is not counted, as theirs does not */
  uint32_t registers_unknown; /* SET_REGISTER of a register or loop state that does not exist */
} hermes_robot;

struct reference_state;
void hermes_robot_init(hermes_robot* robot);
void hermes_robot_act(struct reference_state* state, const hermes_message* message, uint64_t now_us);

#ifdef __cplusplus
}
#endif
#endif
