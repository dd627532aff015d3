/* Four bridges by PWM, direction and enable. Coast is the enable pin low; a duty of 0 with it high brakes. */
#include "firmware_iface/reference/board_stm32f405/board.h"
#include "firmware_iface/reference/board_stm32f405/stm32f405.h"

enum { PWM_STEPS = 8400 }; /* 168 MHz / 20 kHz */
enum { PWM_MODE_1_PRELOADED = 0x68, FIRST_ENABLE = 4 };
enum { OUTPUTS_0_TO_7 = 0x5555, ALTERNATE_9_11_13_14 = 2 << 18 | 2 << 22 | 2 << 26 | 2 << 28 };

void board_motors_init(void) {
  stm32_gpio* port = STM32_GPIOE;
  port->BSRR = 0x00FF0000u; /* bridges off before the pins become outputs */
  port->AFR[1] = 1u << 4 | 1u << 12 | 1u << 20 | 1u << 24;
  port->MODER = OUTPUTS_0_TO_7 | ALTERNATE_9_11_13_14;
  stm32_timer* timer = STM32_TIM1;
  timer->ARR = PWM_STEPS - 1;
  timer->CCMR1 = PWM_MODE_1_PRELOADED | PWM_MODE_1_PRELOADED << 8;
  timer->CCMR2 = PWM_MODE_1_PRELOADED | PWM_MODE_1_PRELOADED << 8;
  timer->CCER = 0x1111;
  timer->EGR = STM32_TIM_UG;
  timer->BDTR = STM32_TIM_MOE;
  timer->CR1 = STM32_TIM_ARPE | STM32_TIM_CEN;
}

void board_motors_drive(const omnihil_drive* drive) {
  for (uint32_t w = 0; w < OMNIHIL_WHEELS; ++w) {
    uint32_t enable = w + FIRST_ENABLE;
    if (drive->mode[w] != OMNIHIL_DRIVE_DUTY) {
      STM32_GPIOE->BSRR = STM32_PIN_CLEAR(enable);
      STM32_TIM1->CCR[w] = 0;
      continue;
    }
    float duty_ratio = (float)drive->duty_ratio[w];
    float size_ratio = duty_ratio < 0.0f ? -duty_ratio : duty_ratio;
    STM32_TIM1->CCR[w] = (uint32_t)(size_ratio * (float)PWM_STEPS + 0.5f);
    STM32_GPIOE->BSRR = duty_ratio < 0.0f ? STM32_PIN_CLEAR(w) : STM32_PIN_SET(w);
    STM32_GPIOE->BSRR = STM32_PIN_SET(enable);
  }
}

void board_motors_off(void) {
  STM32_GPIOE->BSRR = 0x00FF0000u;
  STM32_TIM1->BDTR = 0;
}
