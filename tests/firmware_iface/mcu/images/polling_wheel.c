/* A wheel's controller on a Cortex-M0 that never sleeps: it polls SysTick's COUNTFLAG for its period of 1 ms, as small motor
 * boards do. Six-step by Hall pins, PWM of 24 kHz, currents sampled at each of its periods by ADC and DMA, speed from the
 * encoder timer, commands by a serial port and DMA (ateam-stspin-2025). For boards/ateam_wheel_f031.toml. */
#include "image.h"

#define RCC(offset) REG(0x40021000 + (offset))
#define TIM1(offset) REG(0x40012C00 + (offset))
#define TIM3(offset) REG(0x40000400 + (offset))
#define ADC(offset) REG(0x40012400 + (offset))
#define DMA(offset) REG(0x40020000 + (offset))
#define DMA_CHANNEL(n, offset) DMA(0x08 + 20 * ((n)-1) + (offset))
#define USART1(offset) REG(0x40013800 + (offset))
#define IWDG(offset) REG(0x40003000 + (offset))
#define SYST_CSR REG(0xE000E010)
#define SYST_RVR REG(0xE000E014)
#define SYST_CVR REG(0xE000E018)

enum { kTop = 999, kCommandBytes = 52, kChannels = 4 };

static volatile uint8_t command[kCommandBytes];
static volatile uint16_t samples[kChannels];
volatile uint32_t turns, missed;
volatile float speed_rad_s, setpoint_rad_s;
static float integral;

static void clock_48_MHz(void) {
  REG(0x40022000) = 0x11; /* one wait state, prefetch */
  RCC(0x04) = 10u << 18;  /* PLL = 12 times half of HSI */
  RCC(0x00) |= 1u << 24;
  while ((RCC(0x00) & 1u << 25) == 0) {
  }
  RCC(0x04) |= 2;
  while ((RCC(0x04) & 0xC) != 8) {
  }
  RCC(0x14) |= 1u | 1u << 17 | 1u << 18;      /* DMA, ports A and B */
  RCC(0x18) |= 1u << 9 | 1u << 11 | 1u << 14; /* ADC, TIM1, USART1 */
  RCC(0x1C) |= 1u << 1;                       /* TIM3 */
}

static void peripherals(void) {
  TIM1(0x2C) = kTop;
  TIM1(0x18) = TIM1(0x1C) = 0x0808; /* compare registers preloaded */
  TIM1(0x1C) |= 0x6800;             /* channel 4 in PWM mode, for the ADC's trigger */
  TIM1(0x40) = kTop - 40;
  TIM1(0x20) = 1u << 12;
  TIM1(0x44) = 1u << 15 | 1u << 11 | 1u << 10 | 7; /* outputs on, off state at the idle level, dead time */
  TIM1(0x00) = 0x21;                               /* centre-aligned */
  TIM3(0x08) = 3;
  TIM3(0x18) = 0x0101;
  TIM3(0x2C) = 0xFFFF;
  TIM3(0x00) = 1;
  DMA_CHANNEL(1, 8) = (uint32_t)&ADC(0x40);
  DMA_CHANNEL(1, 12) = (uint32_t)samples;
  DMA_CHANNEL(1, 4) = kChannels;
  DMA_CHANNEL(1, 0) = 1u | 1u << 5 | 1u << 7 | 1u << 8 | 1u << 10;
  ADC(0x08) = 1;
  while ((ADC(0x00) & 1) == 0) {
  }
  ADC(0x28) = 1u << 3 | 1u << 4 | 1u << 16 | 1u << 17;
  ADC(0x0C) = 3u | 1u << 6 | 1u << 10; /* DMA in a circle, at TIM1's fourth channel, rising */
  ADC(0x08) |= 4;
  SYST_RVR = 48000 - 1;
  SYST_CVR = 0;
  SYST_CSR = 5; /* without its exception */
  IWDG(0x00) = 0xCCCC;
  IWDG(0x00) = 0x5555;
  IWDG(0x04) = 4;
  IWDG(0x08) = 40;
}

/* After the first packet: whole ones of so many bytes then stay in their place in the buffer. */
static void listen(void) {
  DMA_CHANNEL(3, 8) = (uint32_t)&USART1(0x24);
  DMA_CHANNEL(3, 12) = (uint32_t)command;
  DMA_CHANNEL(3, 4) = kCommandBytes;
  DMA_CHANNEL(3, 0) = 1u | 1u << 5 | 1u << 7;
  USART1(0x0C) = 24;                                 /* 2 Mbaud */
  USART1(0x08) = 1u << 6;                            /* DMA of what comes in */
  USART1(0x00) = 1u | 1u << 2 | 1u << 10 | 1u << 12; /* 8 bits and even parity */
}

/* By Hall code, for clockwise: the phase at the supply and the one at ground. */
static const uint8_t kHigh[8] = {0, 1, 2, 2, 3, 1, 3, 0}, kLow[8] = {0, 3, 1, 3, 2, 2, 1, 0};

static void commutate(int clockwise, uint32_t compare) {
  const uint32_t hall = REG(0x48000010) & 7;
  const uint32_t high = clockwise ? kHigh[hall] : kLow[hall], low = clockwise ? kLow[hall] : kHigh[hall];
  uint32_t modes[2] = {0x0808, 0x6808}, enables = 1u << 12;
  for (uint32_t phase = 1; phase <= 3; ++phase) {
    if (phase != high && phase != low) continue; /* floats */
    const uint32_t mode = phase == high ? 6 : 4; /* PWM, or held low */
    modes[(phase - 1) / 2] |= mode << ((phase & 1) != 0 ? 4 : 12);
    enables |= 5u << (4 * (phase - 1));
    TIM1(0x34 + 4 * (phase - 1)) = compare;
  }
  TIM1(0x18) = modes[0];
  TIM1(0x1C) = modes[1];
  TIM1(0x20) = enables;
}

static uint32_t word_of_command(int at) {
  return command[at] | (uint32_t)command[at + 1] << 8 | (uint32_t)command[at + 2] << 16 |
         (uint32_t)command[at + 3] << 24;
}

int main(void) {
  clock_48_MHz();
  peripherals();
  uint16_t before = (uint16_t)TIM3(0x24);
  for (;;) {
    IWDG(0x00) = 0xAAAA;
    const uint16_t now = (uint16_t)TIM3(0x24);
    const float rad_s = (float)(int16_t)(now - before) * (6.2831853f / 4000.0f / 1e-3f);
    before = now;
    speed_rad_s += 0.2f * (rad_s - speed_rad_s);
    if (command[0] == 0x21) {
      const uint32_t raw = word_of_command(16);
      float wanted;
      __builtin_memcpy(&wanted, &raw, sizeof wanted);
      setpoint_rad_s = wanted;
    }
    const float error = setpoint_rad_s - speed_rad_s;
    integral += 2e-5f * error;
    if (integral > 0.9f) integral = 0.9f;
    if (integral < -0.9f) integral = -0.9f;
    float duty = 1e-3f * error + integral;
    const int clockwise = duty >= 0.0f;
    if (!clockwise) duty = -duty;
    if (duty > 0.9f) duty = 0.9f;
    commutate(clockwise, (uint32_t)(duty * (float)kTop));
    if (++turns == 2) listen();
    if ((SYST_CSR & 1u << 16) != 0) {
      ++missed;
      continue;
    }
    while ((SYST_CSR & 1u << 16) == 0) {
    }
  }
}
