/* Hangs for ever in its 100th control interrupt after each reset. */
#include "firmware_iface/reference/board_atmega328p/board.h"

void __real_board_control(void);
void __wrap_board_control(void);

void __wrap_board_control(void) {
  static uint8_t periods;
  __real_board_control();
  while (periods == 100) {
  }
  ++periods;
}
