// Smooths a measured record by what its spectrum has above the sensor's noise, so that a fit on it is not pulled low.
//
//   std::vector<double> v = wiener_smoothed(speed, NoiseSpectrum::kWhite).value;        // a speed that is measured
//   std::vector<double> w = wiener_smoothed(slope, NoiseSpectrum::kDifferenced).value;  // central differences of a position
//
// Law: the least-squares estimate of a signal from itself with noise, H(f) = max(0, 1 - S_n(f) / S_x(f)) (N. Wiener,
// Extrapolation, Interpolation, and Smoothing of Stationary Time Series, 1949), as a symmetric kernel in time. Why:
// noise in a regressor makes the coefficient too small by var(x) / (var(x) + var(n)) (Fuller, Measurement Error Models,
// 1987, sec. 1.1.1), above all that of an acceleration, whose noise grows with the square of the band. With the
// regressor's expectation given the measurement in its place the coefficient is right (regression calibration: Carroll
// et al., Measurement Error in Nonlinear Models, 2nd ed. 2006, ch. 4); slopes of the smoothed record are the expected
// slopes, for both are linear.
// Spectrum: periodogram.h. The noise's size is the
// median between half and 0.9 of the Nyquist frequency, so that lines there do not count.
// Validity: evenly spaced samples, noise that has the named spectrum; a motion that fills that band is taken for noise.
// Cannot: tell noise that comes and goes (steps of a coarse encoder at low speed).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace omnihil {

enum class NoiseSpectrum : std::uint8_t {
  kWhite,        // the same at every frequency
  kDifferenced,  // of central_differences (filter.h) of white noise: ((8 sin wT - sin 2wT) / 6)^2
};

// value: n samples, of x's unit; of fewer than kLeastOfSpectrum (periodogram.h) those of x, and no spectrum.
// error_spectrum: what that is still off by, S_e(f) = H(f) S_n(f), the error of the least-squares estimate. At K frequencies evenly
// from 0 to half the rate, x's unit squared; their mean is the error's variance. Cannot: the part of the motion that is lost where
// nothing is let through, which does not stand out of the noise.
// resolved: share of half the rate up to which motion stands out of the noise, the last with H >= 0.5 (S_n = S_x / 2).
struct WienerEstimate {
  std::vector<double> value;
  std::vector<double> error_spectrum;
  double resolved = 1.0;
};
WienerEstimate wiener_smoothed(std::span<const double> x, NoiseSpectrum noise);

}  // namespace omnihil
