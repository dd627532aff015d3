/* Runs for about 20 ms after each reset, then reads where nothing is: a bus fault. Its handler resets the chip,
 * or stays where it is (STAYS). */
#include "image.h"

__attribute__((noinline)) static uint32_t read_nowhere(uint32_t address) { return REG(address); }

int main(void) {
  for (volatile uint32_t i = 0; i < 32000; ++i) {
  }
  return (int)read_nowhere(0xC0000000u);
}

#ifndef STAYS
void HardFault_Handler(void) {
  REG(0xE000ED0C) = 0x05FA0004u; /* AIRCR: SYSRESETREQ */
  for (;;) {
  }
}
#endif
