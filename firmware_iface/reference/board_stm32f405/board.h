/* The board around the reference firmware: an STM32F405 with four H-bridge drivers, four encoders, a battery
 * divider and a serial radio module. main.c is its story; one file per block of the chip.
 *
 *   board_clock_init(); board_motors_init(); board_battery_init(); board_radio_init(); board_tick_start();
 *
 *   what                      where
 *   8 MHz crystal             PLL to 168 MHz; APB1 42 MHz (timers 84), APB2 84 MHz (timers 168)
 *   PWM of motor 0 to 3       TIM1 channels 1 to 4, PE9, PE11, PE13, PE14, 20 kHz
 *   direction of motor 0..3   PE0 to PE3, high: forward
 *   enable of motor 0..3      PE4 to PE7, low: bridge off
 *   encoder of motor 0..3     TIM2 (PA15, PB3), TIM3 (PB4, PB5), TIM4 (PD12, PD13), TIM5 (PA0, PA1)
 *   battery                   ADC1 channel 10, PC0, behind 1:11
 *   radio                     USART1, PA9 and PA10, 1 Mbaud
 *   control period            TIM6, 1 ms; the independent watchdog after 20 ms without one
 *   robot's number            PC6 to PC9, four switches, high: 1
 *   robot's configuration     flash sector 7, 0x08060000 (robot_page.h)
 *
 * Pin numbers and alternate functions: DS8626, table 9. boards/omni_reference_f405.toml says the same to the
 * emulator. Not on this board: current sensing (the reference firmware limits no current), gyro (it reads 0:
 * yaw hold and field-frame commands need one), ball sensor, kicker, dribbler.
 */
#ifndef OMNIHIL_REFERENCE_BOARD_H
#define OMNIHIL_REFERENCE_BOARD_H
#include <stddef.h>
#include <stdint.h>

#include "firmware_iface/omnihil_firmware.h"

void board_clock_init(void);

void board_motors_init(void);
void board_motors_drive(const omnihil_drive* drive);
void board_motors_off(void); /* at once, whatever the rest does */

void board_encoders_init(void);
void board_encoders_read(int64_t counts[OMNIHIL_WHEELS]); /* cumulative; at least every 32767 counts */

void board_battery_init(void);
void board_battery_start(void); /* begins a conversion of about 1.3 us */
double board_battery_V(void);   /* waits for it */

void board_radio_init(void);
size_t board_radio_take(uint8_t* bytes, size_t capacity); /* what came in since */
int board_radio_send(const uint8_t* bytes, size_t count); /* 0: no room, nothing sent */

void board_watchdog_start(void);
void board_watchdog_feed(void); /* at least every 14 ms */

uint32_t board_robot_id(void); /* 0 to 15 */

void board_tick_start(uint32_t period_us); /* board_tick() from now on, by interrupt */
void board_tick(void);                     /* main.c */

#endif
