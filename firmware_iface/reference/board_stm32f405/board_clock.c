/* 168 MHz from the crystal (RM0090 6.3.2: f = 8 MHz / 8 * 336 / 2), the periodic interrupt, and the switches.
 */
#include "firmware_iface/reference/board_stm32f405/board.h"
#include "firmware_iface/reference/board_stm32f405/stm32f405.h"

enum { PLL_M = 8, PLL_N = 336, PLL_P_IS_2 = 0, PLL_Q = 7, PLL_FROM_HSE = 1 << 22 };
enum { APB1_BY_4 = 5 << 10, APB2_BY_2 = 4 << 13, SYSTEM_FROM_PLL = 2, CACHES_AND_5_WAITS = 0x705 };
enum { APB1_TIMERS_MHZ = 84 };

void board_clock_init(void) {
  stm32_rcc* rcc = STM32_RCC;
  rcc->CR |= STM32_RCC_HSEON;
  while (!(rcc->CR & STM32_RCC_HSERDY)) {
  }
  rcc->PLLCFGR = PLL_M | PLL_N << 6 | PLL_P_IS_2 << 16 | PLL_FROM_HSE | PLL_Q << 24;
  rcc->CR |= STM32_RCC_PLLON;
  while (!(rcc->CR & STM32_RCC_PLLRDY)) {
  }
  STM32_FLASH_ACR = CACHES_AND_5_WAITS;
  rcc->CFGR = APB1_BY_4 | APB2_BY_2 | SYSTEM_FROM_PLL;
  while ((rcc->CFGR >> 2 & 3u) != SYSTEM_FROM_PLL) {
  }
  rcc->AHB1ENR |= 0x1Fu;                       /* ports A to E */
  rcc->APB1ENR |= 0x1Fu;                       /* timers 2 to 6 */
  rcc->APB2ENR |= 1u << 0 | 1u << 4 | 1u << 8; /* timer 1, USART1, ADC1 */
  (void)rcc->APB2ENR;                          /* the clocks run two cycles later */
}

void board_tick_start(uint32_t period_us) {
  stm32_timer* timer = STM32_TIM6;
  timer->PSC = APB1_TIMERS_MHZ - 1; /* 1 us */
  timer->ARR = period_us - 1;
  timer->EGR = STM32_TIM_UG;
  timer->SR = 0;
  timer->DIER = STM32_TIM_UIE;
  STM32_NVIC_IPR[STM32_IRQ_TIM6] = 0x20; /* below the radio: it loses no byte while the loops are computed */
  STM32_NVIC_ISER[STM32_IRQ_TIM6 / 32] = 1u << (STM32_IRQ_TIM6 % 32);
  timer->CR1 = STM32_TIM_CEN;
}

uint32_t board_robot_id(void) { return STM32_GPIOC->IDR >> 6 & 0xFu; } /* inputs since reset */

void TIM6_Handler(void) {
  STM32_TIM6->SR = ~(uint32_t)STM32_TIM_UIF;
  board_tick();
}
