// Random numbers of the hidden plants: splitmix64 (Steele, Lea, Flood 2014), Box and Muller 1958.
#pragma once
#include <math.h>

typedef struct {
  unsigned long long state;
} NoiseSource;

static inline double uniform(NoiseSource *s) {
  unsigned long long z = (s->state += 0x9E3779B97F4A7C15ULL);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return ((double)((z ^ (z >> 31)) >> 11) + 0.5) / 9007199254740992.0;
}

static inline double gauss(NoiseSource *s) {
  const double radius = sqrt(-2 * log(uniform(s)));
  return radius * cos(2 * M_PI * uniform(s));
}
