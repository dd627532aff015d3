/* Four wheels at constant speed: PI loops at 1 kHz on encoder timers 2 to 5, PWM of timer 1 with direction
 * pins. Rotor speeds come from a page of flash that the board file presets; serial port 1 echoes what it
 * receives. For an STM32F405, with -DF103 an STM32F103 of high density, -DH743, -DL476;
 * with -DG0B1 three wheels, as it has three timers for encoders. */
#include "image.h"

#if defined(F103)
#define RCC 0x40021000u
#define GPIOE 0x40011800u
#define PORT_SET (GPIOE + 0x10)
#define TIM1 0x40012C00u
#define USART1 0x40013800u
#define TIMER6_MHZ 72u
#elif defined(H743)
#define RCC 0x58024400u
#define GPIOE 0x58021000u
#define PORT_SET (GPIOE + 0x18)
#define TIM1 0x40010000u
#define USART1 0x40011000u
#define TIMER6_MHZ 200u
#elif defined(L476)
#define RCC 0x40021000u
#define GPIOE 0x48001000u
#define PORT_SET (GPIOE + 0x18)
#define TIM1 0x40012C00u
#define USART1 0x40013800u
#define TIMER6_MHZ 80u
#elif defined(G0B1)
#define RCC 0x40021000u
#define GPIOE 0x50001000u
#define PORT_SET (GPIOE + 0x18)
#define TIM1 0x40012C00u
#define USART1 0x40013800u
#define TIMER6_MHZ 64u
#define WHEELS 3
#else
#define RCC 0x40023800u
#define GPIOE 0x40021000u
#define PORT_SET (GPIOE + 0x18)
#define TIM1 0x40010000u
#define USART1 0x40011000u
#define TIMER6_MHZ 84u
#endif
#define TIM6 0x40001000u
#ifndef WHEELS
#define WHEELS 4
#endif
#define PARAMETERS 0x08060000u /* counts per turn, then the four speeds in rad/s of the rotor */

static const uint32_t encoders[4] = {0x40000000u, 0x40000400u, 0x40000800u, 0x40000C00u};
static const float control_period_s = 1e-3f;
volatile uint32_t periods;
volatile float speeds[4];

#if defined(F103)
static void start_clock(void) {
  REG(RCC) |= 1u << 16;
  while (!(REG(RCC) & 1u << 17)) {
  }
  REG(0x40022000) = 0x12;
  REG(RCC + 4) = 4u << 8 | 1u << 16 | 7u << 18; /* HSE x 9; APB1 36 */
  REG(RCC) |= 1u << 24;
  while (!(REG(RCC) & 1u << 25)) {
  }
  REG(RCC + 4) |= 2u; /* 72 MHz */
  while ((REG(RCC + 4) >> 2 & 3) != 2) {
  }
}
static void start_directions(void) { REG(GPIOE) = 0x44443333u; /* CRL: outputs 0 to 3 */ }
#else
static void start_directions(void) { REG(GPIOE) = 0x55u; /* outputs 0 to 3 */ }
#if defined(H743)
static void start_clock(void) {
  REG(0x58024818u) = 3u << 14; /* VOS1 */
  while (!(REG(0x58024818u) & 1u << 13)) {
  }
  REG(RCC) |= 1u << 16;
  while (!(REG(RCC) & 1u << 17)) {
  }
  REG(RCC + 0x28) = 2u | 1u << 4;
  REG(RCC + 0x30) = 99u | 1u << 9 | 3u << 16 | 1u << 24; /* 800 MHz: P 400, Q 200 */
  REG(RCC) |= 1u << 24;
  while (!(REG(RCC) & 1u << 25)) {
  }
  REG(0x52002000u) = 0x24;
  REG(RCC + 0x18) = 8u | 4u << 4; /* HCLK 200, APBs 100 */
  REG(RCC + 0x1C) = 4u << 4 | 4u << 8;
  REG(RCC + 0x20) = 4u << 4;
  REG(RCC + 0x10) = 3u;
  while ((REG(RCC + 0x10) >> 3 & 7) != 3) {
  }
}
#elif defined(G0B1)
static void start_clock(void) {
  REG(RCC) |= 1u << 16;
  while (!(REG(RCC) & 1u << 17)) {
  }
  REG(RCC + 0x0C) = 3u | 16u << 8 | 1u << 28 | 1u << 29; /* HSE x 16 / 2 */
  REG(RCC) |= 1u << 24;
  while (!(REG(RCC) & 1u << 25)) {
  }
  REG(0x40022000u) = 0x602;
  REG(RCC + 8) = 2u;
  while ((REG(RCC + 8) >> 3 & 7) != 2) {
  }
}
#elif defined(L476)
static void start_clock(void) {
  REG(RCC) |= 1u << 16;
  while (!(REG(RCC) & 1u << 17)) {
  }
  REG(RCC + 0x0C) = 3u | 20u << 8 | 1u << 24; /* HSE x 20 / 2 */
  REG(RCC) |= 1u << 24;
  while (!(REG(RCC) & 1u << 25)) {
  }
  REG(0x40022000u) = 0x604;
  REG(RCC + 8) = 3u;
  while ((REG(RCC + 8) >> 2 & 3) != 3) {
  }
}
#else
static void start_clock(void) {
  REG(RCC) |= 1u << 16;
  while (!(REG(RCC) & 1u << 17)) {
  }
  REG(RCC + 4) = 8u | 336u << 6 | 1u << 22 | 7u << 24;
  REG(RCC) |= 1u << 24;
  while (!(REG(RCC) & 1u << 25)) {
  }
  REG(0x40023C00) = 5;
  REG(RCC + 8) = 2u | 5u << 10 | 4u << 13; /* 168 MHz, APB1 42, APB2 84 */
  while ((REG(RCC + 8) >> 2 & 3) != 2) {
  }
}
#endif
#endif

static void start_outputs(void) {
  start_directions();
  REG(TIM1 + 0x2C) = 8399;
  REG(TIM1 + 0x18) = 0x6868;
  REG(TIM1 + 0x1C) = 0x6868;
  REG(TIM1 + 0x20) = 0x1111;
  REG(TIM1 + 0x44) = 1u << 15;
  REG(TIM1 + 0x14) = 1;
  REG(TIM1) = 1u << 7 | 1;
  for (int i = 0; i < WHEELS; ++i) {
    REG(encoders[i] + 0x08) = 3;
    REG(encoders[i]) = 1;
  }
  REG(TIM6 + 0x28) = TIMER6_MHZ - 1; /* 1 us */
  REG(TIM6 + 0x2C) = 999;
  REG(TIM6 + 0x14) = 1;
  REG(TIM6 + 0x10) = 0;
  REG(TIM6) = 1;
}

#if defined(H743) || defined(L476) || defined(G0B1)
static void start_serial(void) {
  REG(USART1 + 0x0C) = 100;
  REG(USART1) = 1u << 3 | 1u << 2 | 1u;
}
static void echo(void) {
  if (REG(USART1 + 0x1C) & 1u << 5) REG(USART1 + 0x28) = REG(USART1 + 0x24);
}
#else
static void start_serial(void) {
  REG(USART1 + 8) = 84;
  REG(USART1 + 0x0C) = 1u << 13 | 1u << 3 | 1u << 2;
}
static void echo(void) {
  if (REG(USART1) & 1u << 5) REG(USART1 + 4) = REG(USART1 + 4);
}
#endif

int main(void) {
  const volatile float *parameters = (const volatile float *)PARAMETERS;
  float integral[4] = {0, 0, 0, 0};
  uint16_t last[4] = {0, 0, 0, 0};
  start_clock();
  start_outputs();
  start_serial();
  for (;;) {
    while (!(REG(TIM6 + 0x10) & 1)) echo();
    REG(TIM6 + 0x10) = 0;
    ++periods;
    for (int i = 0; i < WHEELS; ++i) {
      uint16_t count = (uint16_t)REG(encoders[i] + 0x24);
      float speed = (float)(int16_t)(count - last[i]) * (6.2831853f / parameters[0] / control_period_s);
      last[i] = count;
      speeds[i] += 0.3f * (speed - speeds[i]);
      float error = parameters[1 + i] - speeds[i];
      float duty = 0.002f * error + integral[i];
      if ((duty < 1.0f || error < 0) && (duty > -1.0f || error > 0))
        integral[i] += 0.05f * error * control_period_s;
      if (duty > 1.0f) duty = 1.0f;
      if (duty < -1.0f) duty = -1.0f;
      REG(PORT_SET) = duty >= 0 ? 1u << i : 1u << (16 + i);
      REG(TIM1 + 0x34 + 4 * (uint32_t)i) = (uint32_t)((duty < 0 ? -duty : duty) * 8400.0f);
    }
  }
}
