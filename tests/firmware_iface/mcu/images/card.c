/* A memory card on SDMMC1 of an STM32H743, by polling: block 1 is read, each of its bytes plus one is written to block 2.
 * `result` counts what went wrong. */
#include "image.h"

#define RCC 0x58024400u
#define CARD 0x52007000u
#define STA REG(CARD + 0x34)

static uint32_t rca;
static uint32_t block[128];
static uint32_t wrong;

static uint32_t command(uint32_t index, uint32_t argument, uint32_t answer) {
  REG(CARD + 0x38) = 0x1FE00FFFu;
  REG(CARD + 0x08) = argument;
  REG(CARD + 0x0C) = index | answer << 8 | 1u << 12;
  while (!(STA & (1u | 4u | 64u | 128u))) {
  }
  if (STA & 4u) ++wrong;
  return REG(CARD + 0x14);
}

static void expect(uint32_t read) {
  REG(CARD + 0x24) = 0xFFFFFFFFu;
  REG(CARD + 0x28) = 512;
  REG(CARD + 0x2C) = 9u << 4 | read << 1 | 1u;
}

static void identify(void) {
  REG(CARD) = 3;
  REG(CARD + 0x04) = 80; /* 400 kHz of 64 MHz */
  command(0, 0, 0);
  if (command(8, 0x1AA, 1) != 0x1AA) ++wrong;
  do command(55, 0, 1);
  while (!(command(41, 0x40FF8000u, 2) >> 31));
  command(2, 0, 3);
  rca = command(3, 0, 1) & 0xFFFF0000u;
  command(7, rca, 1);
  command(55, rca, 1);
  command(6, 2, 1);
  REG(CARD + 0x04) = 1u << 14 | 1u << 17 | 2u; /* four lines, flow control, 16 MHz */
}

int main(void) {
  uint32_t *p = block;
  REG(RCC + 0xD4) |= 1u << 16;
  REG(RCC + 0x28) = 1u << 4; /* PLL1 from the HSI: 64 MHz x 4 over 4 at Q */
  REG(RCC + 0x30) = 3u | 3u << 16;
  REG(RCC) |= 1u << 24;
  while (!(REG(RCC) & 1u << 25)) {
  }
  identify();
  expect(1);
  command(17, 1, 1);
  while (!(STA & 256u) || !(STA & 1u << 19)) {
    if (!(STA & 1u << 19) && p < block + 128) *p++ = REG(CARD + 0x80);
    if (STA & (8u | 32u)) return (int)(wrong + 100);
  }
  for (int i = 0; i < 512; ++i) ++((uint8_t *)block)[i];
  command(24, 2, 1);
  expect(0);
  for (p = block; p < block + 128;) {
    while (!(STA & 1u << 14)) {
    }
    for (int i = 0; i < 8; ++i) REG(CARD + 0x80) = *p++;
  }
  while (!(STA & 256u)) {
  }
  while ((command(13, rca, 1) >> 9 & 15) != 4) {
  }
  return (int)wrong;
}
