/* Four quadrature counters (RM0090 18.3.12, encoder mode 3: both edges of both lines), taken as 16 bits and
 * summed up: cumulative counts, as the firmware wants them. */
#include "firmware_iface/reference/board_stm32f405/board.h"
#include "firmware_iface/reference/board_stm32f405/stm32f405.h"

enum { BOTH_EDGES_OF_BOTH = 3, INPUTS_1_AND_2 = 0x0101 };

static stm32_timer* const kTimer[OMNIHIL_WHEELS] = {STM32_TIM2, STM32_TIM3, STM32_TIM4, STM32_TIM5};
static uint16_t last[OMNIHIL_WHEELS];
static int64_t sum[OMNIHIL_WHEELS];

static void alternate(stm32_gpio* port, uint32_t pin, uint32_t function) {
  port->AFR[pin / 8] = (port->AFR[pin / 8] & ~(0xFu << (4 * (pin % 8)))) | function << (4 * (pin % 8));
  port->PUPDR = (port->PUPDR & ~(3u << (2 * pin))) | 1u << (2 * pin); /* pull-up */
  port->MODER = (port->MODER & ~(3u << (2 * pin))) | 2u << (2 * pin);
}

void board_encoders_init(void) {
  alternate(STM32_GPIOA, 15, 1);
  alternate(STM32_GPIOB, 3, 1);
  alternate(STM32_GPIOB, 4, 2);
  alternate(STM32_GPIOB, 5, 2);
  alternate(STM32_GPIOD, 12, 2);
  alternate(STM32_GPIOD, 13, 2);
  alternate(STM32_GPIOA, 0, 2);
  alternate(STM32_GPIOA, 1, 2);
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    kTimer[w]->CCMR1 = INPUTS_1_AND_2;
    kTimer[w]->SMCR = BOTH_EDGES_OF_BOTH;
    kTimer[w]->ARR = 0xFFFF;
    kTimer[w]->CR1 = STM32_TIM_CEN;
    last[w] = (uint16_t)kTimer[w]->CNT;
  }
}

void board_encoders_read(int64_t counts[OMNIHIL_WHEELS]) {
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    uint16_t now = (uint16_t)kTimer[w]->CNT;
    sum[w] += (int16_t)(uint16_t)(now - last[w]);
    last[w] = now;
    counts[w] = sum[w];
  }
}
