/* Four wheels at constant speed on an RP2040: PI loops at 1 kHz by an alarm of TIMER, PWM at 20 kHz on GP2, 4, 6, 8 with
 * direction pins GP10 to GP13. Encoders of wheels 0 and 1 on GP14 to GP17, counted by interrupts of the pins; those of
 * wheels 2 and 3 on GP18 to GP21, counted by PIO: its state machines push the lines' levels at each change. Speeds come
 * from a page of flash that the board file presets; serial port 0 echoes what it receives. */
#include "image.h"

#define RESETS 0x4000C000u
#define CLOCKS 0x40008000u
#define XOSC 0x40024000u
#define PLL_SYS 0x40028000u
#define WATCHDOG 0x40058000u
#define TIMER 0x40054000u
#define IO 0x40014000u
#define PWM 0x40050000u
#define UART0 0x40034000u
#define PIO0 0x50200000u
#define SIO 0xD0000000u
#define PARAMETERS 0x10180000u /* counts per turn, then the four speeds in rad/s of the rotor */
#define CLEAR 0x3000u
#define WHEELS 4

volatile uint32_t periods;
volatile float speeds[WHEELS];
volatile int32_t counts[WHEELS];
static uint32_t lines[WHEELS];
extern uint32_t data_begin, data_end, data_source, bss_begin, bss_end, stack_top;

/* By the levels before and now, two bits each, A the lower one: A leads upwards. */
static void count(int w, uint32_t now) {
  static const int8_t step[16] = {0, 1, -1, 0, -1, 0, 0, 1, 1, 0, 0, -1, 0, -1, 1, 0};
  counts[w] += step[lines[w] << 2 | now];
  lines[w] = now;
}
static void take_pio(int w) {
  uint32_t sm = (uint32_t)w - 2;
  while (!(REG(PIO0 + 4) & 1u << (8 + sm))) count(w, REG(PIO0 + 0x20 + 4 * sm) & 3u);
}
void io_bank0_handler(void) {
  for (uint32_t word = 1; word <= 2; ++word) REG(IO + 0xF0 + 4 * word) = REG(IO + 0x120 + 4 * word);
  uint32_t in = REG(SIO + 4);
  count(0, in >> 14 & 3u);
  count(1, in >> 16 & 3u);
}
void pio0_handler(void) {
  take_pio(2);
  take_pio(3);
}

static void start_clock(void) {
  REG(RESETS + CLEAR) = ~(1u << 24); /* all but USB */
  REG(XOSC + 0x0C) = 47;
  REG(XOSC) = 0xFABAA0;
  while (!(REG(XOSC + 4) & 1u << 31)) {
  }
  REG(PLL_SYS + 8) = 125; /* 12 MHz * 125 / (6 * 2) */
  REG(PLL_SYS + 4) = 0x0C;
  while (!(REG(PLL_SYS) & 1u << 31)) {
  }
  REG(PLL_SYS + 0x0C) = 6u << 16 | 2u << 12;
  REG(PLL_SYS + 4) = 4;
  REG(CLOCKS + 0x30) = 2; /* clk_ref: the crystal */
  while (REG(CLOCKS + 0x38) != 4) {
  }
  REG(CLOCKS + 0x3C) = 1; /* clk_sys: PLL_SYS */
  while (REG(CLOCKS + 0x44) != 2) {
  }
  REG(CLOCKS + 0x48) = 1u << 11; /* clk_peri: clk_sys */
  REG(WATCHDOG + 0x2C) = 1u << 9 | 12;
}

static void start_outputs(void) {
  for (uint32_t w = 0; w < WHEELS; ++w) {
    uint32_t slice = PWM + 0x14 * (w + 1);
    REG(IO + 8 * (2 + 2 * w) + 4) = 4;
    REG(IO + 8 * (10 + w) + 4) = 5;
    REG(slice + 0x10) = 6249; /* 20 kHz */
    REG(slice) = 1;
  }
  REG(SIO + 0x24) = 0xFu << 10;
}

static void start_encoders(void) {
  /* set y to the lines; wait until they are others: push them.  0: in pins 2; 1: mov x isr; 2: mov isr null;
   * 3: jmp x!=y 5; 4: jmp 0; 5: mov y x; 6: mov isr x; 7: push block, wrap to 0 */
  static const uint16_t program[8] = {0x4002, 0xA026, 0xA0C3, 0x00A5, 0x0000, 0xA041, 0xA0C1, 0x8020};
  for (uint32_t pin = 14; pin < 22; ++pin) REG(IO + 8 * pin + 4) = pin < 18 ? 5 : 6;
  for (uint32_t i = 0; i < 8; ++i) REG(PIO0 + 0x48 + 4 * i) = program[i];
  for (uint32_t sm = 0; sm < 2; ++sm) {
    uint32_t at = PIO0 + 0xC8 + 24 * sm;
    REG(at + 4) = 7u << 12;             /* wraps from 7 to 0 */
    REG(at + 8) = 1u << 31;             /* shifts left; eight words to receive */
    REG(at + 20) = (18 + 2 * sm) << 15; /* IN_BASE */
  }
  uint32_t in = REG(SIO + 4);
  for (int w = 0; w < WHEELS; ++w) lines[w] = in >> (14 + 2 * w) & 3u;
  REG(PIO0) = 3;
  REG(PIO0 + 0x12C) = 3;         /* RXNEMPTY of both */
  REG(IO + 0x104) = 0xCC000000u; /* edges of GP14, 15 */
  REG(IO + 0x108) = 0x000000CCu; /* and 16, 17 */
  REG(0xE000E100) = 1u << 13 | 1u << 7;
}

static void start_serial(void) {
  REG(IO + 4) = 2;
  REG(IO + 12) = 2;
  REG(UART0 + 0x24) = 67; /* 115200: 125e6 / (16 * (67 + 52 / 64)) */
  REG(UART0 + 0x28) = 52;
  REG(UART0 + 0x2C) = 0x70;
  REG(UART0 + 0x30) = 0x301;
}

int main(void) {
  const volatile float *parameters = (const volatile float *)PARAMETERS;
  float integral[WHEELS] = {0, 0, 0, 0};
  int32_t last[WHEELS];
  start_clock();
  start_outputs();
  start_encoders();
  start_serial();
  for (int w = 0; w < WHEELS; ++w) last[w] = counts[w];
  uint32_t due = REG(TIMER + 0x28);
  for (;;) {
    due += 1000;
    REG(TIMER + 0x10) = due;
    while (!(REG(TIMER + 0x34) & 1)) {
      if (!(REG(UART0 + 0x18) & 1u << 4)) REG(UART0) = REG(UART0);
    }
    REG(TIMER + 0x34) = 1;
    ++periods;
    for (int w = 0; w < WHEELS; ++w) {
      int32_t now = counts[w];
      float speed = (float)(now - last[w]) * (6.2831853f / parameters[0] / 1e-3f);
      last[w] = now;
      speeds[w] += 0.3f * (speed - speeds[w]);
      float error = parameters[1 + w] - speeds[w];
      float duty = 0.002f * error + integral[w];
      if ((duty < 1.0f || error < 0) && (duty > -1.0f || error > 0)) integral[w] += 0.05f * error * 1e-3f;
      if (duty > 1.0f) duty = 1.0f;
      if (duty < -1.0f) duty = -1.0f;
      REG(SIO + (duty >= 0 ? 0x14 : 0x18)) = 1u << (10 + w);
      REG(PWM + 0x14 * ((uint32_t)w + 1) + 0x0C) = (uint32_t)((duty < 0 ? -duty : duty) * 6250.0f);
    }
  }
}

void Default_Handler(void) {
  for (;;) {
  }
}
void Reset_Handler(void) {
  for (uint32_t *to = &data_begin, *from = &data_source; to < &data_end;) *to++ = *from++;
  for (uint32_t *to = &bss_begin; to < &bss_end;) *to++ = 0;
  main();
}
/* The second stage, which the emulation does not run: nothing, and the checksum that the boot ROM looks for. */
__attribute__((section(".boot2"), used)) static const uint32_t boot2[64] = {[63] = 0x7065399A};
__attribute__((section(".vectors"), used)) static void *const vectors[48] = {&stack_top,
                                                                             Reset_Handler,
                                                                             [2 ... 22] = Default_Handler,
                                                                             [16 + 7] = pio0_handler,
                                                                             [24 ... 28] = Default_Handler,
                                                                             [16 + 13] = io_bank0_handler,
                                                                             [30 ... 47] = Default_Handler};
