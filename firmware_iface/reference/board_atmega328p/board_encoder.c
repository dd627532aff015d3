/* Quadrature by two pin interrupts, every edge. They must not wait: the other interrupts let them in. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/atomic.h>

#include "firmware_iface/reference/board_atmega328p/board.h"

static volatile uint16_t counter;

void board_encoder_init(void) {
  EICRA = 1 << ISC00 | 1 << ISC10; /* any change */
  EIMSK = 1 << INT0 | 1 << INT1;
}

/* Line A (PD2) leads B (PD3) forward: after an edge of A the lines differ, after one of B they are alike. */
ISR(INT0_vect) {
  uint8_t pins = PIND;
  if (((pins >> 1) ^ pins) & 1 << PD2) {
    ++counter;
  } else {
    --counter;
  }
}

ISR(INT1_vect) {
  uint8_t pins = PIND;
  if (((pins >> 1) ^ pins) & 1 << PD2) {
    --counter;
  } else {
    ++counter;
  }
}

int32_t board_encoder_counts(void) {
  static int32_t sum;
  static uint16_t last;
  uint16_t now;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) { now = counter; }
  sum += (int16_t)(uint16_t)(now - last);
  last = now;
  return sum;
}
