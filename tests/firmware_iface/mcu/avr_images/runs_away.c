/* Writes behind the end of its memory in its 100th control interrupt. */
#include "firmware_iface/reference/board_atmega328p/board.h"

void __real_board_control(void);
void __wrap_board_control(void);

void __wrap_board_control(void) {
  static uint8_t periods;
  static volatile uint8_t* volatile behind = (volatile uint8_t*)0x2000;
  __real_board_control();
  if (++periods < 100) return;
  *behind = 1;
}
