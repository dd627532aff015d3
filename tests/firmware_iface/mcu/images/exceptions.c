/* Situations of the exception model. Which one is played is read from the probe; what happens is written to
 * it. */
#include "image.h"

#define PROBE_SCENARIO REG(0x40000000)
#define PROBE_LOG REG(0x40000004)
#define PROBE_RAISE_AFTER REG(0x40000008)  /* line 0 goes high so many cycles from now */
#define PROBE_LINE REG(0x4000000C)         /* line 0 as written */
#define PROBE_SECOND_AFTER REG(0x40000010) /* line 1 likewise */
#define log(value) (PROBE_LOG = (uint32_t)(value))

#define NVIC_ENABLE REG(0xE000E100)
#define NVIC_PEND REG(0xE000E200)
#define NVIC_PRIORITY(irq) REG8(0xE000E400 + (irq))
#define ICSR REG(0xE000ED04)
#define SCR REG(0xE000ED10)
#define CCR REG(0xE000ED14)
#define SHCSR REG(0xE000ED24)
#define CFSR REG(0xE000ED28)
#define HFSR REG(0xE000ED2C)
#define BFAR REG(0xE000ED38)
#define CPACR REG(0xE000ED88)
#define FPCCR REG(0xE000EF34)
#define SYST_CSR REG(0xE000E010)
#define SYST_RVR REG(0xE000E014)
#define SYST_CVR REG(0xE000E018)
#define DEMCR REG(0xE000EDFC)
#define DWT_CTRL REG(0xE0001000)
#define DWT_CYCCNT REG(0xE0001004)
#define SYSTEM_PRIORITY(e) REG8(0xE000ED18 + (e)-4)

typedef void (*Action)(void);
static Action on_irq[4], on_svc, on_pendsv, on_systick, on_fault;
static volatile uint32_t turns, scratch;

static inline void barrier(void) { __asm volatile("dsb\nisb" ::: "memory"); }
static void pend(int irq) {
  NVIC_PEND = 1u << irq;
  barrier();
}

void IRQ0_Handler(void) { on_irq[0](); }
void IRQ1_Handler(void) { on_irq[1](); }
void IRQ2_Handler(void) { on_irq[2](); }
void IRQ3_Handler(void) { on_irq[3](); }
void SVC_Handler(void) { on_svc(); }
void PendSV_Handler(void) { on_pendsv(); }
void SysTick_Handler(void) { on_systick(); }

/* Every fault: logs its number, CFSR, HFSR; then goes on behind the faulting instruction (of `step` bytes).
 */
static volatile uint32_t step = 2;
__attribute__((used)) static void fault(uint32_t *frame) {
  log(ICSR & 0x1FF);
  log(CFSR);
  log(HFSR);
  CFSR = CFSR;
  HFSR = HFSR;
  if (on_fault) on_fault();
  frame[6] += step;
  frame[7] |= 1u << 24;
}
#define FAULT_HANDLER(name)                                               \
  __attribute__((naked)) void name(void) {                                \
    __asm volatile("mrs r0, msp\npush {r4, lr}\nbl fault\npop {r4, pc}"); \
  }
FAULT_HANDLER(HardFault_Handler)
FAULT_HANDLER(BusFault_Handler)
FAULT_HANDLER(UsageFault_Handler)

static void log_1(void) { log(1); }
static void log_2(void) { log(2); }
static void log_3(void) { log(3); }
static void priorities(int p0, int p1, int p2) {
  NVIC_PRIORITY(0) = (uint8_t)p0;
  NVIC_PRIORITY(1) = (uint8_t)p1;
  NVIC_PRIORITY(2) = (uint8_t)p2;
  NVIC_ENABLE = 0xF;
}

/* 1: a more urgent interrupt preempts at once, a less urgent one waits. */
static void outer(void) {
  log(10);
  pend(1);
  pend(2);
  log(11);
}
static void nesting(void) {
  on_irq[0] = outer, on_irq[1] = log_1, on_irq[2] = log_2;
  priorities(0x80, 0x40, 0xC0);
  pend(0);
  log(99);
}

/* 2: pended by its own handler, it runs again. */
static void again(void) {
  log(10 + turns);
  if (turns++ == 0) pend(0);
  log(20);
}
static void pend_in_handler(void) {
  on_irq[0] = again;
  priorities(0x80, 0x40, 0xC0);
  pend(0);
  log(99);
}

/* 3: PRIMASK holds back and releases. 4: BASEPRI lets through what is more urgent. */
static void primask(void) {
  on_irq[0] = log_1;
  priorities(0x80, 0x40, 0xC0);
  __asm volatile("cpsid i");
  pend(0);
  log(10);
  __asm volatile("cpsie i\nisb");
  log(99);
}
static void basepri(void) {
  on_irq[0] = log_1, on_irq[1] = log_2;
  priorities(0xC0, 0x40, 0xC0);
  __asm volatile("msr basepri, %0" ::"r"(0x80));
  pend(0);
  pend(1);
  log(10);
  __asm volatile("msr basepri, %0\nisb" ::"r"(0));
  log(99);
}

/* 5: WFI wakes by an interrupt that PRIMASK holds back. */
static void lower_line(void) {
  log(1);
  PROBE_LINE = 0;
}
static void wfi_masked(void) {
  on_irq[0] = lower_line;
  priorities(0x80, 0x40, 0xC0);
  __asm volatile("cpsid i");
  PROBE_RAISE_AFTER = 1000;
  __asm volatile("wfi");
  log(10);
  __asm volatile("cpsie i\nisb");
  log(99);
}

/* 6: the six values of EXC_RETURN. */
__attribute__((naked)) static void log_lr(void) {
  __asm volatile("mov r1, lr\nldr r0, =0x40000004\nstr r1, [r0]\nbx lr");
}
__attribute__((naked)) static void nested_lr(void) { /* pends IRQ1, whose handler logs its own */
  __asm volatile("ldr r0, =0xE000E200\nmovs r1, #2\nstr r1, [r0]\ndsb\nisb\nbx lr");
}
__attribute__((naked)) static void nested_fp_lr(void) {
  __asm volatile("vmov.f32 s0, s0\nldr r0, =0xE000E200\nmovs r1, #2\nstr r1, [r0]\ndsb\nisb\nbx lr");
}
static uint32_t process_stack[64] __attribute__((aligned(8)));
static uint32_t table[20] __attribute__((aligned(128)));
static void drop_fp(void) { __asm volatile("mrs r0, control\nbic r0, #4\nmsr control, r0\nisb" ::: "r0"); }
static void use_fp(void) { __asm volatile("vmov.f32 s0, s0"); }
static void use_psp(int on) {
  __asm volatile(
      "msr psp, %0\nmrs r0, control\nbfi r0, %1, #1, #1\nmsr control, r0\nisb" ::"r"(process_stack + 62),
      "r"(on)
      : "r0");
}
static void exc_returns(void) {
  for (int i = 0; i < 20; i++) table[i] = REG(0x08000000 + 4 * i);
  table[17] = (uint32_t)log_lr;
  REG(0xE000ED08) = (uint32_t)table;
  priorities(0x80, 0x40, 0xC0);
  for (int fp = 0; fp < 2; fp++) {
    table[16] = (uint32_t)(fp ? nested_fp_lr : nested_lr);
    drop_fp();
    if (fp) use_fp();
    pend(1); /* from thread with the main stack */
    drop_fp();
    use_psp(1);
    if (fp) use_fp();
    pend(1);
    use_psp(0);
    drop_fp();
    pend(0); /* from a handler */
  }
  log(99);
}

/* 7: the main loop checks its FP registers while interrupts spoil theirs. 8: without automatic stacking. */
static void spoil_fp(void) {
  PROBE_LINE = 0;
  turns++;
  __asm volatile(
      "vmov.f32 s0, #1.0\nvmov.f32 s1, s0\nvmov.f32 s7, s0\nvmov.f32 s8, s0\nvmov.f32 s15, s0\nvcmp.f32 s0, "
      "s1\n" ::
          : "s0", "s1", "s7", "s8", "s15", "memory");
  PROBE_RAISE_AFTER = 37 + turns % 61;
}
static void fp_context(void) {
  on_irq[0] = spoil_fp;
  priorities(0x80, 0x40, 0xC0);
  uint32_t errors = 0;
  PROBE_RAISE_AFTER = 100;
  float x = 0.5f, y = 1.5f;
  while (turns < 400) {
    float a = x * y + 0.25f, b = x - y, c = a * b, d = a + b * c;
    if (d - b * c - a > 0.001f || a - d + b * c > 0.001f || x > 1.f || y != 1.5f) errors++;
    x = x > 0.9f ? 0.1f : x + 0.001f;
  }
  NVIC_ENABLE = 0;
  REG(0xE000E180) = 1;
  log(errors);
}
static void fp_context_lost(void) {
  FPCCR = 0;
  barrier();
  drop_fp();
  fp_context();
}

/* 9: SVC from thread, and from a handler that is less urgent; from one as urgent it is a HardFault. */
static void do_svc(void) { __asm volatile("svc 7"); }
static void svc(void) {
  on_svc = log_3, on_irq[0] = do_svc;
  SYSTEM_PRIORITY(11) = 0x40;
  priorities(0x80, 0x40, 0xC0);
  do_svc();
  log(10);
  pend(0);
  log(11);
  step = 0;
  NVIC_PRIORITY(0) = 0x40;
  pend(0);
  log(99);
}

/* 10: PendSV after everything else. */
static void pend_pendsv(void) {
  ICSR = 1u << 28;
  barrier();
  pend(2);
  log(10);
}
static void pendsv(void) {
  on_irq[0] = pend_pendsv, on_irq[2] = log_2, on_pendsv = log_3;
  SYSTEM_PRIORITY(14) = 0xF0;
  priorities(0x80, 0x40, 0xC0);
  pend(0);
  log(99);
}

/* 11: an interrupt at every instant of code with IT blocks and load multiples. */
static void count_turn(void) {
  PROBE_LINE = 0;
  scratch = turns * 7;
  turns++;
}
__attribute__((noinline, naked)) static uint32_t intricate(const uint32_t *from __attribute__((unused))) {
  __asm volatile(
      "push {r4-r7, lr}\nmov r12, r0\nmovs r0, #0\nmovs r5, #6\n"
      "1: ldmia r12, {r1-r4}\nadds r0, r0, r1\neors r0, r2\ncmp r0, #0\n"
      "itete mi\nmvnmi r0, r0\naddpl r0, r0, r3\nsubmi r0, r0, r4\neorpl r0, r0, #0x55\n"
      "ror r0, r0, #3\nstmdb sp, {r0-r3}\nldmdb sp, {r1-r3, r6}\nadd r0, r0, r6\nsubs r5, #1\nbne 1b\n"
      "pop {r4-r7, pc}");
}
static void everywhere(void) {
  static const uint32_t words[4] = {0x12345678, 0x9ABCDEF0, 0x0F1E2D3C, 0x87654321};
  on_irq[0] = count_turn;
  priorities(0x80, 0x40, 0xC0);
  const uint32_t expected = intricate(words);
  uint32_t errors = 0;
  for (uint32_t delay = 0; delay < 200; delay++) {
    PROBE_RAISE_AFTER = delay;
    if (intricate(words) != expected) errors++;
  }
  log(errors);
  log(turns >= 150);
}

/* 12: the more urgent of two arrives while the other is being stacked. */
static void late_arrival(void) {
  on_irq[0] = lower_line, on_irq[1] = log_2;
  priorities(0x80, 0x40, 0xC0);
  PROBE_SECOND_AFTER = 55;
  PROBE_RAISE_AFTER = 50 - 2;
  for (int i = 0; i < 30; i++) scratch = (uint32_t)i;
  log(99);
}

/* 13: faults, each with its own handler and as a HardFault. */
static void faults(void) {
  for (int enabled = 1; enabled >= 0; enabled--) {
    SHCSR = enabled ? 7u << 16 : 0;
    step = 2;
    __asm volatile("udf #1");
    CCR |= 1u << 4 | 1u << 3;
    step = 4;
    __asm volatile("sdiv r0, r0, %0" ::"r"(0) : "r0");
    __asm volatile("ldr.w r0, [%0]" ::"r"(0x20000001) : "r0");
    CCR &= ~(1u << 4 | 1u << 3);
    __asm volatile("ldrd r0, r1, [%0]" ::"r"(0x20000002) : "r0", "r1");
    __asm volatile("ldr.w r0, [%0]" ::"r"(0x30000000) : "r0");
    log(BFAR);
    CPACR = 0;
    barrier();
    __asm volatile("vmov.f32 s0, s1");
    CPACR = 0xFu << 20;
    barrier();
  }
  log(99);
}

/* 14: a jump to an even address. 15: a fault in the HardFault handler. */
static void to_arm_state(void) {
  SHCSR = 7u << 16;
  step = 0;
  __asm volatile("adr r0, 1f\nbx r0\n.balign 4\n1: nop" ::: "r0");
  log(99);
}
static void fault_again(void) { __asm volatile("udf #2"); }
static void lock_up(void) {
  on_fault = fault_again;
  __asm volatile("udf #1");
}

/* 16: a line that stays high pends again. */
static void three_times(void) {
  log(10 + turns);
  if (++turns == 3) PROBE_LINE = 0;
}
static void level(void) {
  on_irq[0] = three_times;
  priorities(0x80, 0x40, 0xC0);
  PROBE_LINE = 1;
  barrier();
  log(99);
}

/* 17: SysTick every 1000 cycles, while asleep. 18: events. */
static void tick(void) { log(turns++); }
static void systick(void) {
  on_systick = tick;
  SYST_RVR = 999;
  SYST_CVR = 0;
  SYST_CSR = 7;
  while (turns < 5) __asm volatile("wfi");
  SYST_CSR = 0;
}
static void events(void) {
  __asm volatile("sev\nwfe");
  log(1);
  on_irq[0] = lower_line;
  priorities(0x80, 0x40, 0xC0);
  PROBE_RAISE_AFTER = 500;
  __asm volatile("wfe");
  log(2);
}

/* 19: cycles as the counter of the core sees them. */
static void cycles(void) {
  DEMCR = 1u << 24;
  DWT_CTRL = 1;
  DWT_CYCCNT = 0;
  const uint32_t before = DWT_CYCCNT;
  __asm volatile("nop\nnop\nnop\nnop\nnop\nnop\nnop\nnop\nnop\nnop");
  log(DWT_CYCCNT - before);
}

/* 20: waiting for what an interrupt sets. */
static void set_scratch(void) {
  PROBE_LINE = 0;
  scratch = 1;
}
static void busy_wait(void) {
  on_irq[0] = set_scratch;
  priorities(0x80, 0x40, 0xC0);
  PROBE_RAISE_AFTER = 100003;
  while (!scratch) {
  }
  log(99);
}

/* 21: through a null pointer. 22: off alignment. 23: bit-band. */
static void null_pointer(void) {
  volatile uint32_t *volatile nowhere = 0;
  log(nowhere[1] != 0);
  nowhere[2] = 5;
}
static void unaligned(void) {
  static uint32_t words[2] = {0x44332211, 0x88776655};
  log(*(volatile uint32_t *)((uintptr_t)words + 1));
}
static void bit_band(void) {
  scratch = 0;
  const uint32_t alias = 0x22000000 + ((uint32_t)&scratch - 0x20000000) * 32;
  REG(alias + 4 * 9) = 1;
  log(scratch);
  log(REG(alias + 4 * 9));
  REG(0x42000000 + 0x0C * 32 + 4 * 0) = 1; /* the probe's line */
  log(PROBE_LINE);
}

int main(void) {
  static const Action kScenarios[] = {
      0,          nesting,      pend_in_handler, primask,         basepri,
      wfi_masked, exc_returns,  fp_context,      fp_context_lost, svc,
      pendsv,     everywhere,   late_arrival,    faults,          to_arm_state,
      lock_up,    level,        systick,         events,          cycles,
      busy_wait,  null_pointer, unaligned,       bit_band};
  kScenarios[PROBE_SCENARIO]();
  return 0;
}
