/* PWM by timer 1, fast, top ICR1 (mode 14), 16 MHz / 800. Such a timer gives at least one step of 800: for a
 * duty of 0 the pin is taken from it and held low. */
#include <avr/io.h>

#include "firmware_iface/reference/board_atmega328p/board.h"

enum { STEPS = 800, DIRECTION = 1 << PB0, PWM = 1 << PB1, ENABLE = 1 << PB2 };

void board_bridge_init(void) {
  PORTB = 0;
  DDRB = DIRECTION | PWM | ENABLE;
  ICR1 = STEPS - 1;
  TCCR1A = 1 << WGM11;
  TCCR1B = 1 << WGM13 | 1 << WGM12 | 1 << CS10;
}

void board_bridge_drive(uint8_t on, float duty_ratio) {
  float size_ratio = duty_ratio < 0.0f ? -duty_ratio : duty_ratio;
  uint16_t steps = (uint16_t)(size_ratio * (float)STEPS + 0.5f);
  if (steps == 0 || !on) {
    TCCR1A = 1 << WGM11;
  } else {
    OCR1A = steps - 1;
    TCCR1A = 1 << WGM11 | 1 << COM1A1;
  }
  uint8_t pins = on ? ENABLE : 0;
  if (duty_ratio >= 0.0f) pins |= DIRECTION;
  PORTB = pins;
}
