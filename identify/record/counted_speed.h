// A measured speed that was counted: pulses of a motor's Hall sensors within a window, over the window.
//
//   CountedSpeed c = counted_speed(values, quantum, period_s, pulse_rad);   // pulse_rad: of the output shaft
//   if (c.window_s > 0.0)
//     add_counting_noise(c, time_s, values, start);   // what counting adds to a true speed
//
// values, time_s: n samples, rad/s (linear axis m/s) and s.
// Quantisation signature: every reading is a multiple of one step q, pulse / q is a time w that such firmware
// counts for, and readings change as a count over w does: by each pulse that comes in and each that goes out
// (window that slides), or not at all for w (window that is held). Speeds differenced from an encoder, or
// rounded to a number format, have steps as well, but change at more samples, or fewer. Law: the reading's
// error is that of the angle rounded to pulses at both ends of the window, over the window; its variance
// 2 (pulse / w)^2 / 12, and its integral never exceeds a pulse (Ohmae and others, IEEE Trans. Ind. Electron.
// 29(3), 1982). Validity: pulses evenly spaced, their number known (six per electrical turn). Cannot: a
// reading that was filtered afterwards; records without slow and even motion, or of less than a hundred
// pulses in it.
#pragma once
#include <vector>

namespace omnihil {

struct CountedSpeed {
  double window_s = 0.0;  // 0: it was not counted
  double pulse_rad = 0.0;
  double sensor_sigma = 0.0;  // of a reading, on top of the count; rad/s

  double noise_sigma() const;           // of a reading, rad/s
  double integrated_sigma_rad() const;  // of the angle that the readings integrate to
};

CountedSpeed counted_speed(const std::vector<double>& values, double quantum, double period_s,
                           double pulse_rad);

// `start`: where the first angle lies between two pulses, 0 to 1. Missing readings (NaN) stay.
void add_counting_noise(const CountedSpeed& counted, const std::vector<double>& time_s,
                        std::vector<double>& values, double start);

}  // namespace omnihil
