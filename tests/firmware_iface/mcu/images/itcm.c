/* Code and data in the RAM at address 0 of an STM32F7, filled by the start-up as its linker script says. */
#include "image.h"

extern uint32_t itcm_begin, itcm_end, itcm_source;
volatile uint32_t table_at, boot_address, boot_option, first_flash_word;

__attribute__((section(".itcm_data"))) volatile uint32_t weights[4] = {1, 10, 100, 1000};
__attribute__((section(".itcm_code"), noinline, long_call)) uint32_t weighted(uint32_t x) {
  weights[0] += 1;
  return x * weights[0] + weights[3];
}

int main(void) {
  boot_address = REG(0xE000ED08);
  boot_option = REG(0x40023C18);
  first_flash_word = REG(0x00200000);
  for (uint32_t *to = &itcm_begin, *from = &itcm_source; to < &itcm_end;) *to++ = *from++;
  __asm volatile("dsb\nisb");
  table_at = (uint32_t)(uintptr_t)weights;
  return (int)(weighted(5) + weighted(5)); /* 5 * 2 + 1000 + 5 * 3 + 1000 */
}
