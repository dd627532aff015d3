/* From reset to main(), and the vector table. A fault lets go of the motors and stays where a debugger finds
 * it. */
#include "firmware_iface/reference/board_stm32f405/board.h"
#include "firmware_iface/reference/board_stm32f405/stm32f405.h"

extern uint32_t data_begin, data_end, data_source, bss_begin, bss_end, stack_top;
int main(void);
void USART1_Handler(void);
void TIM6_Handler(void);

static void fault(void) {
  board_motors_off();
  for (;;) {
  }
}

void Reset_Handler(void) {
  STM32_CPACR |= 0xFu << 20; /* the FPU, before any of its instructions */
  __asm volatile("dsb\nisb");
  for (uint32_t *to = &data_begin, *from = &data_source; to < &data_end;) *to++ = *from++;
  for (uint32_t* to = &bss_begin; to < &bss_end;) *to++ = 0;
  main();
}

typedef union {
  void (*handler)(void);
  const void* stack;
} vector;

__attribute__((section(".vectors"), used)) static const vector kVectors[16 + STM32_IRQS] = {
    [0] = {.stack = &stack_top},
    [1] = {.handler = Reset_Handler},
    [2 ... 6] = {.handler = fault},
    [11 ... 12] = {.handler = fault},
    [14 ... 15] = {.handler = fault},
    [16 ... 16 + STM32_IRQ_USART1 - 1] = {.handler = fault},
    [16 + STM32_IRQ_USART1] = {.handler = USART1_Handler},
    [16 + STM32_IRQ_USART1 + 1 ... 16 + STM32_IRQ_TIM6 - 1] = {.handler = fault},
    [16 + STM32_IRQ_TIM6] = {.handler = TIM6_Handler},
    [16 + STM32_IRQ_TIM6 + 1 ... 16 + STM32_IRQS - 1] = {.handler = fault},
};
