// What the hidden axis's sensors make of a raw record: counts, noise, steps of a converter, Hall pulses, lost
// counts.
#include <math.h>
#include <stdlib.h>

#include "axis_params.h"
#include "noise.h"

static double to_step(double x, double step) { return step > 0 ? round(x / step) * step : x; }

// Pulses seen within the last window_s before row k, over the window: a speed that lags and moves in steps.
static double hall_speed(const AxisParams *p, const double *raw, int k) {
  const double pulse = 2 * M_PI / p->hall_pulses;
  const double back = k - p->hall_window_s / p->sample_s;
  const int j = back > 0 ? (int)floor(back) : 0;
  const double part = back > 0 ? back - j : 0;
  const double *row = raw + j * RAW_COLUMNS, *after = raw + (j < k ? j + 1 : j) * RAW_COLUMNS;
  const double then = row[RAW_ANGLE] + part * (after[RAW_ANGLE] - row[RAW_ANGLE]);
  const double passed = floor(raw[k * RAW_COLUMNS + RAW_ANGLE] / pulse) - floor(then / pulse);
  return passed * pulse / p->hall_window_s;
}

// Exponential smoothing of a reading, a row at a time, from zero: a drive begins at rest.
static double smoothed(double slow, double now, double time_constant_s, double sample_s) {
  return time_constant_s > 0 ? slow + (1 - exp(-sample_s / time_constant_s)) * (now - slow) : now;
}

// `raw` n x RAW_COLUMNS, `seen` n x SEEN_COLUMNS. Noise is drawn from `seed`.
void axis_sense(const AxisParams *p, const double *raw, int n, double seed, double *seen) {
  NoiseSource noise = {.state = (unsigned long long)seed * 2654435761ULL + 99};
  const double count = 2 * M_PI / p->encoder_cpr;
  double lost = 0, last = 0, slow_A = 0, slow_rad_s = 0;
  for (int k = 0; k < n; k++, raw += RAW_COLUMNS, seen += SEEN_COLUMNS) {
    const double angle = p->encoder_on_output > 0 ? raw[RAW_OUT_ANGLE] : raw[RAW_ANGLE];
    const double shown = angle + p->encoder_swing_rad * sin(angle + p->encoder_swing_phase);
    const double counts = floor(shown / count);
    if (p->lost_per_count > 0) {
      for (double passed = fabs(counts - last); passed >= 1; passed--)
        if (uniform(&noise) < p->lost_per_count) lost += counts > last ? 1 : -1;
      last = counts;
    }
    seen[SEEN_COUNTS] = counts - lost;
    seen[SEEN_BUS] = to_step(raw[RAW_BUS] + p->bus_noise_V * gauss(&noise), 0.005);
    slow_A = smoothed(slow_A, raw[RAW_CURRENT], p->current_filter_s, p->sample_s);
    slow_rad_s = smoothed(slow_rad_s, raw[RAW_OUT_SPEED], p->speed_filter_s, p->sample_s);
    seen[SEEN_CURRENT] = to_step(slow_A + p->current_noise_A * gauss(&noise), 0.01);
    // Speed and position are told at the output; Hall sensors sit at the rotor.
    const double hall = p->hall_window_s > 0 ? hall_speed(p, raw - k * RAW_COLUMNS, k) / p->gear : 0;
    seen[SEEN_SPEED] = p->hall_window_s > 0 ? hall : slow_rad_s + p->speed_noise_rad_s * gauss(&noise);
    seen[SEEN_ANGLE] = raw[RAW_OUT_ANGLE] + p->angle_noise_rad * gauss(&noise);
  }
}

// Inner products of m series of n values each (row-major): the normal equations of a least squares fit.
void inner_products(const double *rows, int m, int n, double *out) {
  for (int a = 0; a < m; a++)
    for (int b = a; b < m; b++) {
      double sum = 0;
      for (int k = 0; k < n; k++) sum += rows[a * n + k] * rows[b * n + k];
      out[a * m + b] = out[b * m + a] = sum;
    }
}
