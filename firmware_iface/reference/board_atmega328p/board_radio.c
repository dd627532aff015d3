/* The serial radio: 250 kbaud, 8N1, received by interrupt into a ring, sent by interrupt from another one. */
#include <avr/interrupt.h>
#include <avr/io.h>

#include "firmware_iface/reference/board_atmega328p/board.h"

enum { BAUD_DIVIDER = 3, RING = 64 }; /* 16 MHz / 16 / 4; two packets */

static volatile uint8_t in[RING], in_put, in_got;
static volatile uint8_t out[RING], out_put, out_got;

void board_radio_init(void) {
  UBRR0 = BAUD_DIVIDER;
  UCSR0C = 1 << UCSZ01 | 1 << UCSZ00;
  UCSR0B = 1 << RXCIE0 | 1 << RXEN0 | 1 << TXEN0;
}

ISR(USART_RX_vect) {
  uint8_t byte = UDR0;
  if ((uint8_t)(in_put - in_got) < RING) in[in_put++ % RING] = byte; /* full: the checksum tells */
}

ISR(USART_UDRE_vect) {
  if (out_got != out_put) {
    UDR0 = out[out_got++ % RING];
  } else {
    UCSR0B &= ~(1 << UDRIE0);
  }
}

uint8_t board_radio_take(uint8_t* byte) {
  if (in_got == in_put) return 0;
  *byte = in[in_got++ % RING];
  return 1;
}

void board_radio_send(const uint8_t* bytes, uint8_t count) {
  if (RING - (uint8_t)(out_put - out_got) < count) return;
  for (uint8_t i = 0; i < count; ++i) out[out_put++ % RING] = bytes[i];
  UCSR0B |= 1 << UDRIE0;
}
