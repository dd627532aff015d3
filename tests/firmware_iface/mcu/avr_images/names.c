/* One variable of every kind that an AVR has its own size or place for; the values are what the tests expect. */
#include <avr/eeprom.h>
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <avr/sleep.h>

enum mode { MODE_IDLE, MODE_DRIVING = 300 };

struct axis {
  int last;
  double gain;
  uint8_t level : 3;
  int8_t trim : 5;
  enum mode mode;
  volatile uint8_t* port;
  long table[2][2];
};

volatile int whole = -1234;
volatile double ratio = 0.625;
volatile long long wide = -5000000000LL;
volatile struct axis axes[2] = {{7, 1.5, 5, -9, MODE_DRIVING, &PORTB, {{1, -2}, {3, -4}}}};
volatile uint32_t cleared;
const uint8_t in_flash[4] PROGMEM = {1, 2, 3, 4};
uint16_t in_eeprom EEMEM = 99;
volatile int left_out = 4; /* by the linker: nothing refers to it */
static int gone = 5;
static int spent;

int main(void) {
  static volatile uint8_t turns;
  static const uint16_t words[2] PROGMEM = {500, 600};
  cleared = pgm_read_byte(&in_flash[cleared & 3]) + eeprom_read_word(&in_eeprom) + (uint8_t)gone;
  for (int i = 0; i < 2; ++i) cleared += pgm_read_word(&words[i]);
  spent = gone;
  set_sleep_mode(SLEEP_MODE_IDLE);
  TCCR0B = 1 << CS00;
  TIMSK0 = 1 << TOIE0;
  sei();
  for (;;) {
    ++turns;
    axes[1].last = axes[0].last + whole;
    axes[1].gain = ratio;
    axes[1].table[0][0] = (long)wide;
    sleep_mode();
  }
}

ISR(TIMER0_OVF_vect) {}
