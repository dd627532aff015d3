/* Battery voltage: ADC6 at 125 kHz (13 clocks: 104 us), begun in one control period and read in the next. */
#include <avr/io.h>

#include "firmware_iface/reference/board_atmega328p/board.h"

enum { AVCC_REFERENCE = 1 << REFS0, CHANNEL = 6, BY_128 = 7 };
static const float kVoltsPerCount = 5.0f * 6.0f / 1024.0f;

void board_battery_init(void) {
  ADMUX = AVCC_REFERENCE | CHANNEL;
  ADCSRA = 1 << ADEN | 1 << ADSC | BY_128;
  while (ADCSRA & 1 << ADSC) {
  }
}

float board_battery_V(void) {
  uint16_t counts = ADC;
  ADCSRA |= 1 << ADSC;
  return (float)counts * kVoltsPerCount;
}
