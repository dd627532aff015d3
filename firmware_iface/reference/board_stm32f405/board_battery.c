/* Battery voltage: ADC1 channel 10 at 21 MHz, 15 + 12 clocks, behind a divider of 1:11 (10 k and 1 k). */
#include "firmware_iface/reference/board_stm32f405/board.h"
#include "firmware_iface/reference/board_stm32f405/stm32f405.h"

enum { CHANNEL = 10, SAMPLE_15_CLOCKS = 1, ADC_CLOCK_BY_4 = 1 << 16 };
#define STM32_ADC_CCR (*(stm32_register *)0x40012304u)
static const double kReference_V = 3.3;
static const double kDivider = 11.0;

void board_battery_init(void) {
  STM32_GPIOC->MODER |= 3u; /* PC0: analog */
  STM32_ADC_CCR = ADC_CLOCK_BY_4;
  STM32_ADC1->SMPR1 = SAMPLE_15_CLOCKS << (3 * (CHANNEL - 10));
  STM32_ADC1->SQR1 = 0;
  STM32_ADC1->SQR3 = CHANNEL;
  STM32_ADC1->CR2 = STM32_ADC_ADON;
}

void board_battery_start(void) { STM32_ADC1->CR2 = STM32_ADC_ADON | STM32_ADC_SWSTART; }

double board_battery_V(void) {
  while (!(STM32_ADC1->SR & STM32_ADC_EOC)) {
  }
  return (double)(STM32_ADC1->DR & 0xFFFu) * (kReference_V * kDivider / 4096.0);
}
