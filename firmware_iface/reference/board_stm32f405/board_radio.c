/* The radio module on USART1, 1 Mbaud, 8N1, by interrupt in both directions. A byte stream: the frames of the
 * format carry their own delimiter, so no gap on the line means anything here. */
#include "firmware_iface/reference/board_stm32f405/board.h"
#include "firmware_iface/reference/board_stm32f405/stm32f405.h"

enum { BAUD_DIVIDER = 84 }; /* 84 MHz / 84, oversampled by 16 */
enum { RING = 256 };        /* 2.5 ms of line; one control period brings at most 100 bytes */

typedef struct {
  uint8_t bytes[RING];
  volatile uint32_t put, got; /* both only rise; each is written from one side alone */
} ring;

static ring in, out;

void board_radio_init(void) {
  stm32_gpio* port = STM32_GPIOA;
  port->AFR[1] |= 7u << 4 | 7u << 8;
  port->PUPDR |= 1u << 20; /* the line rests high */
  port->MODER |= 2u << 18 | 2u << 20;
  STM32_USART1->BRR = BAUD_DIVIDER;
  STM32_USART1->CR1 = STM32_USART_UE | STM32_USART_TE | STM32_USART_RE | STM32_USART_RXNE;
  STM32_NVIC_IPR[STM32_IRQ_USART1] = 0x10;
  STM32_NVIC_ISER[STM32_IRQ_USART1 / 32] = 1u << (STM32_IRQ_USART1 % 32);
}

void USART1_Handler(void) {
  uint32_t status = STM32_USART1->SR;
  if (status & STM32_USART_RXNE) {
    uint8_t byte = (uint8_t)STM32_USART1->DR;
    if (in.put - in.got < RING) in.bytes[in.put++ % RING] = byte; /* full: the frame's checksum tells */
  }
  if ((status & STM32_USART_TXE) && (STM32_USART1->CR1 & STM32_USART_TXE)) {
    if (out.got != out.put) {
      STM32_USART1->DR = out.bytes[out.got++ % RING];
    } else {
      STM32_USART1->CR1 &= ~(uint32_t)STM32_USART_TXE;
    }
  }
}

size_t board_radio_take(uint8_t* bytes, size_t capacity) {
  size_t count = 0;
  while (count < capacity && in.got != in.put) bytes[count++] = in.bytes[in.got++ % RING];
  return count;
}

int board_radio_send(const uint8_t* bytes, size_t count) {
  if (RING - (out.put - out.got) < count) return 0;
  for (size_t i = 0; i < count; ++i) out.bytes[out.put++ % RING] = bytes[i];
  /* The interrupt clears this bit, too; one that comes in between is made good by the bit being set here. */
  STM32_USART1->CR1 |= STM32_USART_TXE;
  return 1;
}
