/* A program of which a test knows every variable's value: names_fill() gives them. */
#include "names.h"

struct names_wheel wheel[4];
volatile int64_t far_below;
static volatile uint8_t counter;
static volatile float shared; /* names_other.c has one, too */
const int kept = 42;
static __thread int per_thread;

static int calls_of(int add) {
  static int calls;
  calls += add;
  return calls;
}

__attribute__((noinline)) int names_fill(int argument) {
  int local = argument * 2;
  for (int i = 0; i < 4; ++i) {
    struct names_wheel* w = &wheel[i];
    w->last = (int16_t)(-100 - i);
    w->gains.kp = 0.5f + (float)i;
    w->gains.ki = -0.125 * i;
    w->integral = 0.25f * (float)i;
    w->level = 5;
    w->trim = -9;
    w->wide = 0x123456789AULL + (unsigned)i;
    w->on = i % 2 == 1;
    w->mode = i == 0 ? kNamesIdle : i == 1 ? kNamesDriving : kNamesBraking;
    w->flag = i == 3 ? kNamesHigh : kNamesLow;
    w->label = (const char*)0x1234;
    w->word = 0x04030201u;
    for (int j = 0; j < 6; ++j) w->table[j / 3][j % 3] = (int16_t)(10 * i + j - 3);
  }
  far_below = INT64_MIN + 5;
  counter = 250;
  shared = 1.5f;
  per_thread += argument;
  return calls_of(7) + local + per_thread;
}
