/* The firmware of a board that drives one wheel: four of them, all listening to the robot's radio, are a robot.
 *
 *   wheel_node_init(&node, &config, 2);                                    // this board turns wheel 2
 *   wheel_node_byte(&node, byte);                                          // each byte of the radio
 *   wheel_node_drive drive = wheel_node_control(&node, counts, bus_V);     // every 2 ms: 9000 cycles of an ATmega328P
 *   if (node.plan_due) wheel_node_plan(&node);                             // 30000, in the main loop
 *
 * The same parts as the four-wheel firmware has (motion_reference, wheel_encoder, wheel_controller,
 * command_watchdog, radio_hermes), shared out so that an 8-bit core without a multiplier for floats keeps up:
 * every board plans the whole robot's motion, 8 ms ahead, and follows its own wheel's part of it, in a
 * straight line from plan to plan. The plans of the four boards are the same because they hear the same
 * packets. Packets: SPEED_MOVE, SPEED_MOVE_ADVANCE (its motion), OPEN_LOOP_COMMAND; wheel 0's board answers
 * PING_REQUEST and GET_BATTERIE. Cannot: gyro, kicker, dribbler, registers; start smoothly from wheels that
 * are turning.
 */
#ifndef OMNIHIL_REFERENCE_WHEEL_NODE_H
#define OMNIHIL_REFERENCE_WHEEL_NODE_H
#include "firmware_iface/omnihil_firmware.h"
#include "firmware_iface/reference/command_watchdog.h"
#include "firmware_iface/reference/motion_reference.h"
#include "firmware_iface/reference/radio_hermes.h"
#include "firmware_iface/reference/wheel_controller.h"
#include "firmware_iface/reference/wheel_encoder.h"
#include "firmware_iface/reference/wheel_geometry.h"
#include "firmware_iface/reference/wheel_tuning.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { WHEEL_NODE_PERIOD_US = 2000, WHEEL_NODE_PERIODS_PER_PLAN = 4 };

/* What the control loop follows until the next plan. */
typedef struct wheel_plan {
  float omega_rotor_rad_s; /* at its end */
  float torque_rotor_Nm;   /* feed-forward, all along */
  uint8_t on;              /* 0: bridge off */
  uint8_t open_loop;
  float duty_ratio; /* of an open loop */
} wheel_plan;

/* What the control loop knows when a plan is due. */
typedef struct wheel_seen {
  uint64_t now_us;
  float bus_V;
  float omega_rotor_rad_s;
} wheel_seen;

typedef struct wheel_node_drive {
  uint8_t on;
  float duty_ratio; /* -1..1 */
} wheel_node_drive;

typedef struct wheel_node {
  uint8_t wheel;
  wheel_geometry geometry;
  wheel_tuning tuning;
  command_watchdog watchdog;
  hermes_radio radio; /* the main loop's alone from here on */
  motion_reference motion;
  float body[BODY_AXES]; /* as commanded */
  float duty_ratio;
  uint8_t open_loop;
  uint8_t following;
  wheel_seen main;

  /* The two loops hand over by plan_due: while it is 1 the main loop reads `seen` and writes `next`, while it
   * is 0 the control loop writes `seen` and reads `next`. */
  volatile uint8_t plan_due;
  wheel_seen seen;
  wheel_plan next;

  wheel_plan plan; /* the control loop's alone from here on */
  uint64_t now_us;
  float omega_rotor_ref_rad_s, omega_rotor_step_rad_s;
  uint8_t until_plan;
  wheel_encoder encoder;
  wheel_loop loop;
  wheel_node_drive drive;
} wheel_node;

/* 0, or nonzero when these wheels cannot move the robot in every direction. */
int wheel_node_init(wheel_node* node, const omnihil_robot_config* config, uint8_t wheel);
void wheel_node_byte(wheel_node* node, uint8_t byte);
/* One command that came another way than by radio; 0, or nonzero: refused. */
int wheel_node_command(wheel_node* node, const omnihil_command* command);
wheel_node_drive wheel_node_control(wheel_node* node, int64_t counts, float bus_V);
void wheel_node_plan(wheel_node* node);

#ifdef __cplusplus
}
#endif
#endif
