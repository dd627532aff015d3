/* The reference firmware: wheel-speed control of a four-wheel robot, plain C, no heap, no clock, no I/O.
 *
 *   const omnihil_firmware_api* api = omnihil_reference_firmware();   // or omnihil_firmware_get(1)
 *   memset(state, 0, api->state_bytes);
 *   api->init(state, &config);
 *   api->command(state, &command, now_us);                            // or api->radio_receive(); both every 1 ms
 *   api->tick(state, &sensors, &drive);
 *
 * The state is one struct without pointers: copy it and both copies go on alike.
 * Speaks the radio format "ulaval-hermes" itself; any other format reaches it through command().
 * Gains: loop 3 (body yaw) has p in 1/s; loop 4 (wheels) has p in V s/rad, i in V/rad, d in V s^2/rad, all at
 * the rotor. The other loops do not exist here: their gains are stored and given back, and do nothing.
 */
#ifndef OMNIHIL_REFERENCE_FIRMWARE_H
#define OMNIHIL_REFERENCE_FIRMWARE_H
#include "firmware_iface/omnihil_firmware.h"
#include "firmware_iface/reference/belbic.h"
#include "firmware_iface/reference/command_watchdog.h"
#include "firmware_iface/reference/hermes_robot.h"
#include "firmware_iface/reference/kicker.h"
#include "firmware_iface/reference/motion_reference.h"
#include "firmware_iface/reference/radio_hermes.h"
#include "firmware_iface/reference/wheel_controller.h"
#include "firmware_iface/reference/wheel_encoder.h"
#include "firmware_iface/reference/wheel_geometry.h"
#include "firmware_iface/reference/wheel_tuning.h"
#include "firmware_iface/reference/yaw_estimate.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { REFERENCE_PERIOD_US = 1000 };
enum { LOOP_YAW = 3, LOOP_WHEELS = 4 };

/* init(): why a configuration was refused */
enum {
  REFERENCE_CONFIG_OK = 0,
  REFERENCE_CONFIG_NOT_FINITE = 1,   /* a number is NaN or infinite */
  REFERENCE_CONFIG_NOT_POSITIVE = 2, /* a radius, ratio, resistance, constant, voltage or count is <= 0 */
  REFERENCE_CONFIG_TIMEOUT = 3,      /* negative or above an hour */
  REFERENCE_CONFIG_WHEELS = 4        /* these wheel angles cannot move the robot in every direction */
};

typedef struct reference_state {
  omnihil_robot_config config;
  wheel_geometry geometry;
  wheel_tuning tuning;
  omnihil_gains gains;

  omnihil_command command; /* the one in force */
  command_watchdog watchdog;
  uint32_t commands_refused; /* not finite, unknown mode, duty outside -1..1 */
  hermes_radio radio;
  hermes_robot hermes;

  uint64_t now_us; /* of the last tick */
  uint32_t ticks;
  uint32_t sensors_refused; /* ticks with a value that is not finite: the last good one was used */
  uint32_t following;       /* the wheel loops are closed */
  float bus_V;              /* last good measurement, filtered for the report only */
  float battery_V;
  float gyro_rad_s;
  float accel_m_s2[2];
  float yaw_output_rad_s;       /* of the yaw hold */
  float body_target[BODY_AXES]; /* as commanded, in the body frame */
  float body_estimate[BODY_AXES];
  float body_slope[BODY_AXES];
  uint32_t ball_seen;
  float capacitor_V; /* 0: the board measures none */
  yaw_estimate yaw;
  motion_reference motion;
  wheel_encoder encoder[OMNIHIL_WHEELS];
  wheel_loop loop[OMNIHIL_WHEELS];
  uint32_t emotional; /* wheels by belbic.h instead */
  belbic_loop emotion[OMNIHIL_WHEELS];
  kicker kick;
  omnihil_drive drive; /* as last given */
} reference_state;

const omnihil_firmware_api* omnihil_reference_firmware(void);
/* The same with belbic.h in the wheels. */
const omnihil_firmware_api* omnihil_emotional_firmware(void);

/* A double as a float, limited to +-1e30: far beyond any robot, and products of it stay finite. */
float narrowed(double value);
/* Checks the whole command, then puts it in force. 0, or nonzero: refused, nothing changed. */
int reference_take_motion(reference_state* state, const omnihil_command* command, uint64_t now_us);
/* The same, and its kick and charge: what command() does. */
int reference_take_command(reference_state* state, const omnihil_command* command, uint64_t now_us);
void reference_tick(reference_state* state, const omnihil_sensors* sensors, omnihil_drive* drive);
void reference_feedback(const reference_state* state, omnihil_feedback* feedback);

#ifdef __cplusplus
}
#endif
#endif
