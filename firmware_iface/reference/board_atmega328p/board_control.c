/* The control period: timer 0 clears on compare A, 16 MHz / 256 / 125 = 500 Hz. The loop takes 0.6 ms, in
 * which 60 encoder edges may come: it lets all interrupts in but itself. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>

#include "firmware_iface/reference/board_atmega328p/board.h"

enum { BY_256 = 1 << CS02, COUNTS = 125 };

void board_control_start(void) {
  TCCR0A = 1 << WGM01;
  TCCR0B = BY_256;
  OCR0A = COUNTS - 1;
  TCNT0 = 0;
  TIFR0 = 1 << OCF0A;
  TIMSK0 = 1 << OCIE0A;
  wdt_enable(WDTO_15MS);
}

ISR(TIMER0_COMPA_vect) {
  TIMSK0 = 0;
  sei();
  board_control();
  wdt_reset();
  cli();
  TIMSK0 = 1 << OCIE0A;
}
