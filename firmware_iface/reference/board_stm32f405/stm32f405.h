/* The registers of an STM32F405 that this board layer uses, from RM0090 (addresses: section 2.3; interrupt
 * numbers: table 62; registers: the blocks' own sections).
 *
 *   STM32_GPIOE->BSRR = STM32_PIN_SET(3);
 */
#ifndef OMNIHIL_REFERENCE_STM32F405_H
#define OMNIHIL_REFERENCE_STM32F405_H
#include <stdint.h>

typedef volatile uint32_t stm32_register;

typedef struct {
  stm32_register CR, PLLCFGR, CFGR, CIR, AHB1RSTR, AHB2RSTR, AHB3RSTR, gap_1C, APB1RSTR, APB2RSTR, gap_28,
      gap_2C, AHB1ENR, AHB2ENR, AHB3ENR, gap_3C, APB1ENR, APB2ENR;
} stm32_rcc;

typedef struct {
  stm32_register MODER, OTYPER, OSPEEDR, PUPDR, IDR, ODR, BSRR, LCKR, AFR[2];
} stm32_gpio;

typedef struct {
  stm32_register CR1, CR2, SMCR, DIER, SR, EGR, CCMR1, CCMR2, CCER, CNT, PSC, ARR, RCR, CCR[4], BDTR;
} stm32_timer;

typedef struct {
  stm32_register SR, DR, BRR, CR1, CR2, CR3;
} stm32_usart;

typedef struct {
  stm32_register SR, CR1, CR2, SMPR1, SMPR2, JOFR[4], HTR, LTR, SQR1, SQR2, SQR3, JSQR, JDR[4], DR;
} stm32_adc;

typedef struct {
  stm32_register KR, PR, RLR, SR;
} stm32_watchdog;

#define STM32_TIM2 ((stm32_timer *)0x40000000u)
#define STM32_TIM3 ((stm32_timer *)0x40000400u)
#define STM32_TIM4 ((stm32_timer *)0x40000800u)
#define STM32_TIM5 ((stm32_timer *)0x40000C00u)
#define STM32_TIM6 ((stm32_timer *)0x40001000u)
#define STM32_IWDG ((stm32_watchdog *)0x40003000u)
#define STM32_TIM1 ((stm32_timer *)0x40010000u)
#define STM32_USART1 ((stm32_usart *)0x40011000u)
#define STM32_ADC1 ((stm32_adc *)0x40012000u)
#define STM32_GPIOA ((stm32_gpio *)0x40020000u)
#define STM32_GPIOB ((stm32_gpio *)0x40020400u)
#define STM32_GPIOC ((stm32_gpio *)0x40020800u)
#define STM32_GPIOD ((stm32_gpio *)0x40020C00u)
#define STM32_GPIOE ((stm32_gpio *)0x40021000u)
#define STM32_RCC ((stm32_rcc *)0x40023800u)
#define STM32_FLASH_ACR (*(stm32_register *)0x40023C00u)
#define STM32_NVIC_ISER ((stm32_register *)0xE000E100u)
#define STM32_NVIC_IPR ((volatile uint8_t *)0xE000E400u)
#define STM32_CPACR (*(stm32_register *)0xE000ED88u)

#define STM32_PIN_SET(pin) (1u << (pin))
#define STM32_PIN_CLEAR(pin) (1u << ((pin) + 16u))

enum { STM32_IRQ_USART1 = 37, STM32_IRQ_TIM6 = 54, STM32_IRQS = 82 };
enum {
  STM32_RCC_HSEON = 1 << 16,
  STM32_RCC_HSERDY = 1 << 17,
  STM32_RCC_PLLON = 1 << 24,
  STM32_RCC_PLLRDY = 1 << 25,
  STM32_TIM_CEN = 1 << 0,
  STM32_TIM_ARPE = 1 << 7,
  STM32_TIM_UIE = 1 << 0,
  STM32_TIM_UIF = 1 << 0,
  STM32_TIM_UG = 1 << 0,
  STM32_TIM_MOE = 1 << 15,
  STM32_USART_RXNE = 1 << 5, /* in SR and, as an interrupt's enable, in CR1 */
  STM32_USART_TXE = 1 << 7,
  STM32_USART_UE = 1 << 13,
  STM32_USART_TE = 1 << 3,
  STM32_USART_RE = 1 << 2,
  STM32_ADC_EOC = 1 << 1,
  STM32_ADC_ADON = 1 << 0,
  STM32_ADC_SWSTART = 1 << 30
};

#endif
