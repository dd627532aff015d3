/* Two tasks in turn, as FreeRTOS lays them out: pxCurrentTCB, and control blocks with the name behind two list items.
 * "control" gives way by itself, "blink" is preempted every millisecond. */
#include "image.h"

#define ICSR REG(0xE000ED04)
#define SHPR3 REG(0xE000ED20)
#define SYST_CSR REG(0xE000E010)
#define SYST_RVR REG(0xE000E014)

typedef struct {
  uint32_t *top_of_stack;
  uint32_t state_item[5], event_item[5];
  uint32_t priority, *stack;
  char name[16];
} Task;

static uint32_t stacks[2][128];
static Task tasks[2] = {{.name = "control"}, {.name = "blink"}};
Task *volatile pxCurrentTCB;
volatile uint32_t switches, blinks, controls;

__attribute__((noinline)) static void give_way(void) {
  ICSR = 1u << 28;
  __asm volatile("dsb\nisb" ::: "memory");
}

__attribute__((noinline)) static void control_step(void) { ++controls; }
__attribute__((noinline)) static void blink_step(void) {
  for (volatile int i = 0; i < 300; ++i) {
  }
  ++blinks;
}
static void control(void) {
  for (;;) {
    control_step();
    give_way();
  }
}
static void blink(void) {
  for (;;) blink_step();
}

__attribute__((used)) static uint32_t *other_task(uint32_t *top) {
  pxCurrentTCB->top_of_stack = top;
  pxCurrentTCB = pxCurrentTCB == &tasks[0] ? &tasks[1] : &tasks[0];
  ++switches;
  return pxCurrentTCB->top_of_stack;
}

__attribute__((naked)) void PendSV_Handler(void) {
  __asm volatile(
      "mrs r0, psp\n"
      "stmdb r0!, {r4-r11, lr}\n"
      "bl other_task\n"
      "ldmia r0!, {r4-r11, lr}\n"
      "msr psp, r0\n"
      "bx lr\n");
}
__attribute__((naked)) void SVC_Handler(void) {
  __asm volatile(
      "ldr r0, =pxCurrentTCB\n"
      "ldr r0, [r0]\n"
      "ldr r0, [r0]\n"
      "ldmia r0!, {r4-r11, lr}\n"
      "msr psp, r0\n"
      "bx lr\n");
}
void SysTick_Handler(void) { ICSR = 1u << 28; }

static void make(Task *task, uint32_t *stack, void (*body)(void)) {
  uint32_t *top = stack + 128;
  *--top = 1u << 24;                        /* xPSR */
  *--top = (uint32_t)(uintptr_t)body & ~1u; /* pc */
  for (int i = 0; i < 6; ++i) *--top = 0;
  *--top = 0xFFFFFFFDu; /* to thread mode on the process stack */
  for (int i = 0; i < 8; ++i) *--top = 0;
  task->stack = stack;
  task->top_of_stack = top;
}

int main(void) {
  make(&tasks[0], stacks[0], control);
  make(&tasks[1], stacks[1], blink);
  pxCurrentTCB = &tasks[0];
  SHPR3 = 0xFFFF0000u;
  SYST_RVR = 15999; /* 1 ms of 16 MHz */
  SYST_CSR = 7;
  __asm volatile("svc 0");
  return 0;
}
