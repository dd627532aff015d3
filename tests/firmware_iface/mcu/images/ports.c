/* What the ports of a board are tested with. Serial port 2 says "boot" and gives back every letter as a capital. CAN 1
 * takes frame 0x100, a duty in 1/8400 for wheel 0, and answers 0x101 with the wheel's encoder count; any other frame
 * comes back with the next id and its bytes plus one. Words go out by semihosting, by ITM and through a buffer in RAM (RTT),
 * where letters that come in through another one follow as capitals. */
#include "image.h"

#define USART2 0x40004400u
#define CAN1 0x40006400u
#define TIM1 0x40010000u
#define TIM2 0x40000000u
#define GPIOE 0x40021000u
#define ITM 0xE0000000u

static void say(const char *text) {
  for (; *text; ++text) {
    while (!(REG(USART2) & 1u << 7)) {
    }
    REG(USART2 + 4) = (uint8_t)*text;
  }
}

static void semihost(uint32_t operation, const void *argument) {
  register uint32_t r0 __asm__("r0") = operation;
  register const void *r1 __asm__("r1") = argument;
  __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void trace(const char *text) {
  if (!(REG(ITM + 0xE80) & 1) || !(REG(ITM + 0xE00) & 1)) return;
  for (; *text; ++text) {
    while (!(REG(ITM) & 1)) {
    }
    REG8(ITM) = (uint8_t)*text;
  }
}

/* The control block of SEGGER RTT: identifier, numbers of channels, channels. */
static struct {
  char identifier[16];
  uint32_t up, down;
  struct {
    const char *name;
    char *buffer;
    uint32_t size;
    volatile uint32_t written, read;
    uint32_t flags;
  } channel[2];
} terminal;
static char terminal_buffer[16], heard_buffer[8];
static const char *left_to_say = "by rtt, and it is longer than the buffer\n";

static void open_terminal(void) {
  terminal.channel[0].name = "Terminal";
  terminal.channel[0].buffer = terminal_buffer;
  terminal.channel[0].size = sizeof terminal_buffer;
  terminal.up = 1;
  terminal.channel[1].buffer = heard_buffer;
  terminal.channel[1].size = sizeof heard_buffer;
  terminal.down = 1;
  const char identifier[] = "SEGGER RTT";
  for (unsigned i = 0; i < sizeof identifier; ++i) terminal.identifier[i] = identifier[i];
}

static char capital_of(char c) { return (char)(c >= 'a' && c <= 'z' ? c - 32 : c); }

/* As much as there is room for: nobody may read. */
static void say_more(void) {
  const uint32_t next = (terminal.channel[0].written + 1) % sizeof terminal_buffer;
  if (next == terminal.channel[0].read) return;
  char c = *left_to_say;
  if (c) {
    ++left_to_say;
  } else {
    if (terminal.channel[1].read == terminal.channel[1].written) return;
    c = capital_of(heard_buffer[terminal.channel[1].read]);
    terminal.channel[1].read = (terminal.channel[1].read + 1) % sizeof heard_buffer;
  }
  terminal_buffer[terminal.channel[0].written] = c;
  terminal.channel[0].written = next;
}

static void start(void) {
  REG(USART2 + 8) = 139; /* 115200 of 16 MHz */
  REG(USART2 + 0x0C) = 1u << 13 | 1u << 3 | 1u << 2;
  REG(CAN1) = 1;                           /* INRQ */
  REG(CAN1 + 0x1C) = 12u << 16 | 1u << 20; /* 16 quanta: 1 Mbit/s of 16 MHz */
  REG(CAN1 + 0x200) |= 1;                  /* filters: bank 0 takes all into FIFO 0 */
  REG(CAN1 + 0x20C) = 1;
  REG(CAN1 + 0x240) = REG(CAN1 + 0x244) = 0;
  REG(CAN1 + 0x21C) = 1;
  REG(CAN1 + 0x200) &= ~1u;
  REG(CAN1) = 0;
  REG(GPIOE) = 0x55u;
  REG(TIM1 + 0x2C) = 8399;
  REG(TIM1 + 0x18) = REG(TIM1 + 0x1C) = 0x6868;
  REG(TIM1 + 0x20) = 0x1111;
  REG(TIM1 + 0x44) = 1u << 15;
  REG(TIM1 + 0x14) = 1;
  REG(TIM1) = 1u << 7 | 1;
  REG(TIM2 + 0x08) = 3;
  REG(TIM2 + 0x2C) = 0xFFFFFFFFu;
  REG(TIM2) = 1;
}

static void answer(void) {
  const uint32_t id = REG(CAN1 + 0x1B0) >> 21, size = REG(CAN1 + 0x1B4) & 15;
  uint32_t low = REG(CAN1 + 0x1B8), high = REG(CAN1 + 0x1BC);
  REG(CAN1 + 0x0C) = 1u << 5; /* released */
  if (id == 0x100) {
    const int16_t duty = (int16_t)low;
    REG(GPIOE + 0x18) = duty >= 0 ? 1u : 1u << 16;
    REG(TIM1 + 0x34) = (uint32_t)(duty < 0 ? -duty : duty);
    low = REG(TIM2 + 0x24);
    high = 0;
  } else {
    low += 0x01010101u; /* bytes below 255 */
    high += 0x01010101u;
  }
  while (!(REG(CAN1 + 0x08) & 1u << 26)) {
  }
  REG(CAN1 + 0x184) = id == 0x100 ? 4 : size;
  REG(CAN1 + 0x188) = low;
  REG(CAN1 + 0x18C) = high;
  REG(CAN1 + 0x180) = (id + 1) << 21 | 1;
}

int main(void) {
  start();
  say("boot\r\n");
  semihost(4, "by semihosting\n");
  trace("by trace\n");
  open_terminal();
  for (;;) {
    say_more();
    if (REG(USART2) & 1u << 5) {
      const char capital[2] = {capital_of((char)REG(USART2 + 4)), 0};
      say(capital);
    }
    if (REG(CAN1 + 0x0C) & 3) answer();
  }
}
