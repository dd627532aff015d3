/* The board of one wheel: an ATmega328P at 16 MHz with an H-bridge driver, an encoder, a battery divider and
 * the robot's serial radio, on which all four boards listen. main.c is its story.
 *
 *   what                   where
 *   PWM                    OC1A, PB1, 20 kHz in 800 steps; direction PB0, high: forward; enable PB2, low: off
 *   encoder                PD2 (INT0) and PD3 (INT1), every edge of both lines: up to 1024 counts per turn
 *   control period         timer 0, compare A, 2 ms; the watchdog after 15 ms without one
 *   battery                ADC6 behind 1:6, against 5 V
 *   radio                  USART0, PD0 and PD1, 250 kbaud; wheel 0's board alone sends
 *   which wheel            PC0, PC1: two switches, high: 1
 *   robot's number         PC2 to PC5: four switches
 *   robot's configuration  EEPROM from 0: "OMNI" and twelve 32-bit floats (board_config.c)
 *
 * Sources of numbers: data sheet DS40002061B. boards/omni_reference_avr.toml says the same to the emulator.
 */
#ifndef OMNIHIL_REFERENCE_BOARD_AVR_H
#define OMNIHIL_REFERENCE_BOARD_AVR_H
#include <stdint.h>

#include "firmware_iface/omnihil_firmware.h"

void board_bridge_init(void);
void board_bridge_drive(uint8_t on, float duty_ratio);

void board_encoder_init(void);
int32_t board_encoder_counts(void); /* cumulative; at least every 32767 counts */

void board_battery_init(void);
float board_battery_V(void); /* of the conversion begun at the last call */

void board_radio_init(void);
uint8_t board_radio_take(uint8_t* byte); /* 0: none is waiting */
void board_radio_send(const uint8_t* bytes, uint8_t count);

uint8_t board_wheel(void);
int board_config(omnihil_robot_config* config); /* nonzero: the EEPROM is erased or foreign */

void board_control_start(void);
void board_control(void); /* main.c, by interrupt, with the others enabled */

#endif
