/* A control interrupt that every 100th time takes 2.5 periods: of the two that come meanwhile the flag keeps
 * one. */
#include <util/delay.h>

#include "firmware_iface/reference/board_atmega328p/board.h"

void __real_board_control(void);
void __wrap_board_control(void);

void __wrap_board_control(void) {
  static uint8_t periods;
  __real_board_control();
  if (++periods < 100) return;
  periods = 0;
  _delay_ms(4.0);
}
