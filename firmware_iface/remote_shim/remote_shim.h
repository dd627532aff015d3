/* The shim for a board on the desk: its PWM, encoder and radio calls, answered by the bench over a serial line.
 *
 *   static omnihil_remote remote;
 *   omnihil_remote_init(&remote, "my robot", "", 1000, uart_write, &uart2);   // 1000 us control period
 *   omnihil_remote_receive(&remote, byte);       // in the receive interrupt of the UART, or from the main loop
 *
 *   while (omnihil_remote_tick(&remote)) {       // in place of the timer interrupt: once per control period
 *     int32_t counts = omnihil_remote_encoder(&remote, 0);     // in place of TIMx->CNT
 *     omnihil_remote_set_duty(&remote, 0, duty);               // in place of TIMx->CCR1
 *     omnihil_remote_done(&remote, took_us);                   // sends what was set
 *   }
 *
 * C99, no heap, no floating point beyond float, about 1 kB of RAM. One sender: omnihil_remote_done() and
 * omnihil_remote_radio_write() write frames, call them from one context. The write function takes all bytes
 * or queues them; it may block for as long as they take on the wire. A board that falls behind gets the
 * newest sensors and counts those it skipped. What it cannot do: motor_tick() of three-phase bridges (a
 * serial line is too slow for one exchange per PWM period).
 */
#ifndef OMNIHIL_REMOTE_SHIM_H
#define OMNIHIL_REMOTE_SHIM_H
#include "remote_frame.h"

#ifdef __cplusplus
extern "C" {
#endif

#define OMNIHIL_REMOTE_WHEELS 4

typedef void (*omnihil_remote_write)(void* port, const uint8_t* bytes, size_t count);

/* What the bench says of the robot, once. Members as in omnihil_robot_config (omnihil_firmware.h). */
typedef struct omnihil_remote_robot {
  uint32_t robot_id;
  float wheel_angle_rad[OMNIHIL_REMOTE_WHEELS];
  float wheel_radius_m, wheel_center_radius_m, gear_ratio, encoder_counts_per_rotor_turn;
  float bus_voltage_nominal_V, motor_resistance_ohm, motor_torque_constant_Nm_per_A, command_timeout_s;
} omnihil_remote_robot;

/* What the bench's radio asks for. Members and numbers as in omnihil_command. */
typedef struct omnihil_remote_command {
  uint8_t mode, flags, kick, kick_when;
  float v_forward_m_s, v_left_m_s, omega_body_rad_s;
  float omega_wheel_rad_s[OMNIHIL_REMOTE_WHEELS], duty_ratio[OMNIHIL_REMOTE_WHEELS];
  float yaw_target_rad, camera_yaw_rad, v_kick_m_s, kick_pulse_s, dribbler_ratio;
} omnihil_remote_command;

typedef struct omnihil_remote_sensors {
  uint32_t now_us;                               /* of the robot; wraps */
  int32_t encoder_counts[OMNIHIL_REMOTE_WHEELS]; /* the low 32 bits: wraps */
  int16_t motor_current_mA[OMNIHIL_REMOTE_WHEELS];
  uint16_t bus_voltage_mV;
  int16_t gyro_z_mrad_s, accel_x_mm_s2, accel_y_mm_s2;
  uint8_t ball_seen;
  uint16_t
      drive_number; /* of the DRIVE that is in force from now on, as a board with motors says it; 0: none, or not told */
} omnihil_remote_sensors;

typedef struct omnihil_remote {
  const char* name;
  const char* radio_format; /* whose frames the board decodes itself; "": it takes commands */
  uint16_t control_period_us;
  omnihil_remote_write write;
  void* port;
  omnihil_remote_decoder decoder;
  omnihil_remote_robot robot;
  omnihil_remote_sensors sensors;
  omnihil_remote_command command;
  uint16_t sequence; /* of the sensors */
  uint8_t configured, sensors_new, command_new;
  uint8_t radio[OMNIHIL_REMOTE_PAYLOAD_MAX];
  size_t radio_count;
  /* what the next DRIVE frame says */
  uint8_t mode[OMNIHIL_REMOTE_WHEELS];
  int16_t duty[OMNIHIL_REMOTE_WHEELS];
  uint8_t flags, dribbler;
  uint16_t kick_pulse_us;
  uint32_t skipped_ticks; /* sensors that were overwritten before omnihil_remote_tick() saw them */
  uint32_t lost_radio;    /* radio frames, likewise */
} omnihil_remote;

void omnihil_remote_init(omnihil_remote* remote, const char* name, const char* radio_format,
                         uint16_t control_period_us, omnihil_remote_write write, void* port);
void omnihil_remote_receive(omnihil_remote* remote, uint8_t byte);

/* 1 once per control period, when new sensors are there. */
int omnihil_remote_tick(omnihil_remote* remote);
int32_t omnihil_remote_encoder(const omnihil_remote* remote, int wheel);
/* 1 when a new command came since the last call. */
int omnihil_remote_take_command(omnihil_remote* remote, omnihil_remote_command* command);
/* Bytes of the radio frame that came, 0: none. */
size_t omnihil_remote_radio_read(omnihil_remote* remote, uint8_t* bytes, size_t capacity);
void omnihil_remote_radio_write(omnihil_remote* remote, const uint8_t* bytes, size_t count);

void omnihil_remote_set_duty(omnihil_remote* remote, int wheel, float duty_ratio); /* held to -1 .. 1 */
void omnihil_remote_coast(omnihil_remote* remote, int wheel);
void omnihil_remote_set_dribbler(omnihil_remote* remote, float ratio);
void omnihil_remote_set_charge(omnihil_remote* remote, int on);
/* OMNIHIL_KICK_*; for the one frame that follows. */
void omnihil_remote_kick(omnihil_remote* remote, uint8_t kick, uint16_t pulse_us);
/* Ends the control period: sends the drive. took_us: how long the board needed, 0: it does not tell. */
void omnihil_remote_done(omnihil_remote* remote, uint16_t took_us);

#ifdef __cplusplus
}
#endif
#endif
