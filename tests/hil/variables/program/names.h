/* What names.c has by name, for the compiler of the test as well. */
#ifndef OMNIHIL_TESTS_NAMES_H
#define OMNIHIL_TESTS_NAMES_H
#include <stdbool.h>
#include <stdint.h>

enum names_mode { kNamesIdle = -1, kNamesDriving = 3, kNamesBraking = 200 };
enum names_flag { kNamesLow, kNamesHigh };

typedef struct {
  float kp;
  double ki;
} names_gains;

struct names_wheel {
  int16_t last;
  names_gains gains;
  float integral;
  unsigned level : 3;
  int trim : 5;
  unsigned : 2;
  uint64_t wide : 37;
  bool on;
  enum names_mode mode;
  enum names_flag flag;
  const char* label;
  union {
    uint32_t word;
    uint8_t byte[4];
  };
  int16_t table[2][3];
};
#endif
