/* The reference firmware's board without its watchdog: code that hangs hangs for good, with its bridges on. */
#include "firmware_iface/reference/board_stm32f405/board.h"

void board_watchdog_start(void) {}
void board_watchdog_feed(void) {}
