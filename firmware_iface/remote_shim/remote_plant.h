/* The shim the other way round: a board with real motors that a program on a computer drives, period by period.
 *
 *   static omnihil_remote_plant plant;
 *   omnihil_remote_plant_init(&plant, &robot, 50, uart_write, &uart2);     // 50 periods without a drive: let go
 *   omnihil_remote_plant_receive(&plant, byte);       // in the receive interrupt of the UART, or from the main loop
 *
 *   plant.sensors.encoder_counts[0] = counts;         // and its time, currents, battery: just read
 *   omnihil_remote_plant_tick(&plant);                // in the timer interrupt: once per control period
 *   if (omnihil_remote_plant_drives(&plant, 0)) set_pwm(omnihil_remote_plant_duty(&plant, 0)); else coast();
 *
 * tick() takes the newest DRIVE into force and sends the sensors with its number, so that the computer knows to the period
 * what was in force when. A time-out of periods without a new DRIVE lets all motors go: it is what stops them when the
 * computer, the cable or the program is gone, and a board must not be without. Until a program answers, and again behind a time-out,
 * HELLO is sent five times a second. C99, no heap, about 400 bytes of RAM; the same frames and numbers as remote_shim.h.
 */
#ifndef OMNIHIL_REMOTE_PLANT_H
#define OMNIHIL_REMOTE_PLANT_H
#include "remote_shim.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct omnihil_remote_plant {
  omnihil_remote_robot robot; /* what HELLO says: gear ratio, counts per turn, nominal battery … */
  omnihil_remote_write write;
  void* port;
  omnihil_remote_decoder decoder;
  omnihil_remote_sensors sensors; /* the caller's to fill before tick(); its drive_number is tick()'s own */
  uint16_t timeout_periods;       /* at least 1 */
  uint16_t number;                /* of the sensors, from 1 */
  uint16_t silent_periods;
  uint32_t next_hello_us;
  uint8_t greeted, said_hello, drive_new;
  uint16_t came_number, drive_number; /* of the newest drive; of that in force, 0: none */
  uint8_t came_mode[OMNIHIL_REMOTE_WHEELS], mode[OMNIHIL_REMOTE_WHEELS];
  int16_t came_duty[OMNIHIL_REMOTE_WHEELS], duty[OMNIHIL_REMOTE_WHEELS];
} omnihil_remote_plant;

void omnihil_remote_plant_init(omnihil_remote_plant* plant, const omnihil_remote_robot* robot,
                               uint16_t timeout_periods, omnihil_remote_write write, void* port);
void omnihil_remote_plant_receive(omnihil_remote_plant* plant, uint8_t byte);
void omnihil_remote_plant_tick(omnihil_remote_plant* plant);
/* 0: the bridge is off. */
int omnihil_remote_plant_drives(const omnihil_remote_plant* plant, int wheel);
float omnihil_remote_plant_duty(const omnihil_remote_plant* plant, int wheel); /* -1 .. 1 */

#ifdef __cplusplus
}
#endif
#endif
