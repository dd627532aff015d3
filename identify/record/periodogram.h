// Averaged periodograms of a record, and what of one signal another does not explain.
//
//   Periodogram p = periodogram_of(x, segment_length(x.size()));
//   double sigma = incoherent_sigma(torque, speed, 0.2);  // NaN: too short
//
// Welch (IEEE Trans. Audio Electroacoust. 15, 1967), Hann window, half overlapped, without each segment's mean.
// Coherence: the power of x that is no linear function of y is S_x (1 - |S_xy|^2 / (S_x S_y)), and of an estimate by K independent
// segments 1 - 1 / K of that (Bendat, Piersol, Random Data, 4th ed. 2010, sec. 6.1 and 9.2).
// Validity: evenly spaced samples. Cannot: tell noise from a part of x that y does not explain linearly: an upper bound there.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace omnihil {

inline constexpr std::size_t kLeastOfSpectrum = 256;  // derived: eight segments of the shortest length
// Of half the rate, up to which noise is looked for: above it anti-aliasing filters act, and differences of a position have
// no noise left.
inline constexpr double kNoiseTo = 0.9;  // a choice

// power: length / 2 + 1 values, summed over the segments; relative standard deviation kWelchDeviation / sqrt(segments).
// window_square: sum of the window's squares, of all segments: the power of white noise of variance 1.
inline constexpr double kWelchDeviation = 1.03;  // source: Welch 1967, Hann, half overlapped
struct Periodogram {
  std::vector<double> power;
  double segments = 0.0;
  double window_square = 0.0;
};
// A power of two: 32 to 1024 samples, by cost and resolution (at 1 kHz 1 Hz), of which at least eight fit into the record.
std::size_t segment_length(std::size_t samples);
Periodogram periodogram_of(std::span<const double> x, std::size_t length);

// Median over mean of a chi-square of as many degrees as the average of `segments` has.
double median_over_mean(double segments);

// 1-sigma of x's white part, by what y ([n] as x) does not explain from `band` to 0.9 of half the rate (median over
// frequencies); in x's unit. NaN of fewer than kLeastOfSpectrum samples or where nothing varies.
double incoherent_sigma(std::span<const double> x, std::span<const double> y, double band);

}  // namespace omnihil
