/* A phase's voltage that steps every eight periods of the PWM, between two duties of leg 1 around the half that legs 2 and 3
 * have, and phase 1's current by the converter at each period's update: what steps at an update is seen in the samples from
 * there on. Centre-aligned, with preload: 403 / 8 us a period at the 16 MHz of reset, so that the updates wander through the
 * plant's periods. */
#include "image.h"

#define TIM1 0x40010000u
#define ADC1 0x40012000u
enum { kTop = 403, kMiddle = 201, kStep = 160, kPeriods = 2048 };

/* Of the period that began at the update: the current at its begin. */
volatile uint16_t samples[kPeriods];
volatile uint32_t taken;

int main(void) {
  REG(ADC1 + 0x08) = 1; /* input 0, the shortest sampling */
  REG(TIM1 + 0x30) = 1; /* one update a period */
  REG(TIM1 + 0x2C) = kTop;
  REG(TIM1 + 0x34) = REG(TIM1 + 0x38) = REG(TIM1 + 0x3C) = kMiddle;
  REG(TIM1 + 0x18) = 0x6868;
  REG(TIM1 + 0x1C) = 0x68;
  REG(TIM1 + 0x20) = 0x111;
  REG(TIM1 + 0x44) = 1u << 15;
  REG(TIM1 + 0x14) = 1;
  REG(TIM1 + 0x10) = 0;
  REG(TIM1) = 1u << 7 | 1u << 5 | 1;
  for (uint32_t n = 0; n < kPeriods; ++n) {
    while (!(REG(TIM1 + 0x10) & 1)) {
    }
    REG(TIM1 + 0x10) = 0;
    REG(ADC1 + 0x08) = 1 | 1u << 30;
    while (!(REG(ADC1) & 2)) {
    }
    samples[n] = (uint16_t)REG(ADC1 + 0x4C);
    taken = n + 1;
    if (n % 8 == 7)
      REG(TIM1 + 0x34) = (n / 8 & 1) != 0 ? kMiddle - kStep : kMiddle + kStep; /* acts at the next update */
  }
  REG(TIM1 + 0x20) = 0;
  for (;;) {
  }
}
