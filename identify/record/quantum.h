// The step of a sensor that counts: an encoder, an angle from a converter of few bits, a speed from pulses.
//
//   quantum_of({0.0, 0.1, 0.1, 0.3, 0.2, 0.2, 0.1, 0.1});   // 0.1, as far as doubles go
//
// A record shows its step by having few different values: at most one in three of its samples. Cannot: tell a step
// finer than the noise that is added behind the counter, or than one in three samples.
#pragma once
#include <vector>

namespace omnihil {

// Smallest difference between two of the values, in their unit; 0: none is seen. Values that are not finite do not count.
double quantum_of(std::vector<double> values);

}  // namespace omnihil
