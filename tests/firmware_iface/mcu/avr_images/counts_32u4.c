/* ATmega32U4: a quarter of full duty on OC1A, every edge of two lines counted, the count sent every 2 ms. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

static volatile uint8_t count;

ISR(INT0_vect) { ++count; }
ISR(INT1_vect) { ++count; }
ISR(TIMER0_COMPA_vect) { UDR1 = count; }

int main(void) {
  DDRB = 1 << PB5 | 1 << PB4;
  PORTB = 1 << PB4;
  TCCR1A = 1 << WGM11 | 1 << COM1A1;
  ICR1 = 799;
  OCR1A = 199;
  TCCR1B = 1 << WGM13 | 1 << WGM12 | 1 << CS10;
  EICRA = 1 << ISC00 | 1 << ISC10;
  EIMSK = 1 << INT0 | 1 << INT1;
  UBRR1 = 3;
  UCSR1B = 1 << TXEN1;
  TCCR0A = 1 << WGM01;
  OCR0A = 124;
  TIMSK0 = 1 << OCIE0A;
  TCCR0B = 1 << CS02;
  sei();
  for (;;) sleep_mode();
}
