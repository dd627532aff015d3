/* The independent watchdog, RM0090 21: 160 counts of 32 kHz / 4 are 20 ms (LSI: 17 to 47 kHz, so 14 to 38
 * ms). A firmware that hangs is reset; the pins float then, and the drivers' own pull-downs let go of the
 * motors. */
#include "firmware_iface/reference/board_stm32f405/board.h"
#include "firmware_iface/reference/board_stm32f405/stm32f405.h"

enum { START = 0xCCCC, UNLOCK = 0x5555, RELOAD = 0xAAAA, BY_4 = 0, COUNTS = 160 };

void board_watchdog_start(void) {
  STM32_IWDG->KR = START;
  STM32_IWDG->KR = UNLOCK;
  STM32_IWDG->PR = BY_4;
  STM32_IWDG->RLR = COUNTS;
}

void board_watchdog_feed(void) { STM32_IWDG->KR = RELOAD; }
