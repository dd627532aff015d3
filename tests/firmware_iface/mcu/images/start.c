/* Vector table and start-up of the test images. Handlers are weak; `result` and `done` are what tests look
 * at. */
#include "image.h"

volatile uint32_t result, done;
extern uint32_t data_begin, data_end, data_source, bss_begin, bss_end, stack_top;
int main(void);

void Default_Handler(void) {
  for (;;) {
  }
}
void Reset_Handler(void) {
  for (uint32_t *to = &data_begin, *from = &data_source; to < &data_end;) *to++ = *from++;
  for (uint32_t *to = &bss_begin; to < &bss_end;) *to++ = 0;
#if defined(__ARM_FP)
  REG(0xE000ED88) |= 0xFu << 20;
  __asm volatile("dsb\nisb");
#endif
  result = (uint32_t)main();
  done = 1;
  for (;;) __asm volatile("wfi");
}
#define WEAK(name) void name(void) __attribute__((weak, alias("Default_Handler")))
WEAK(NMI_Handler);
WEAK(HardFault_Handler);
WEAK(MemManage_Handler);
WEAK(BusFault_Handler);
WEAK(UsageFault_Handler);
WEAK(SVC_Handler);
WEAK(PendSV_Handler);
WEAK(SysTick_Handler);
WEAK(IRQ0_Handler);
WEAK(IRQ1_Handler);
WEAK(IRQ2_Handler);
WEAK(IRQ3_Handler);

__attribute__((section(".vectors"), used)) static void *const vectors[20] = {&stack_top,
                                                                             Reset_Handler,
                                                                             NMI_Handler,
                                                                             HardFault_Handler,
                                                                             MemManage_Handler,
                                                                             BusFault_Handler,
                                                                             UsageFault_Handler,
                                                                             0,
                                                                             0,
                                                                             0,
                                                                             0,
                                                                             SVC_Handler,
                                                                             0,
                                                                             0,
                                                                             PendSV_Handler,
                                                                             SysTick_Handler,
                                                                             IRQ0_Handler,
                                                                             IRQ1_Handler,
                                                                             IRQ2_Handler,
                                                                             IRQ3_Handler};
