// Zero-phase low-pass filter for measured records: Butterworth, forward and backward.
//
//   LowPass f = butterworth(4, 100.0, 1000.0);              // order, cutoff in Hz, rate in Hz
//   std::vector<double> y = zero_phase(f, x);               // no delay, gain squared: -6 dB at the cutoff
//
// Law: analogue prototype 1 / B_n(s), bilinear transform with prewarped cutoff, as sections of second order
// (S. Butterworth, Wireless Engineer 7, 1930; Oppenheim, Schafer, Discrete-Time Signal Processing, ch. 7).
// Ends: the record is continued point-symmetrically by three times the filter's length and each section
// starts settled, as filtfilt of the usual tools does (F. Gustafsson, IEEE Trans. Signal Proc. 44(4), 1996,
// sec. I). Validity: evenly spaced samples, cutoff below half the rate. Cannot: gaps (resample first).
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

namespace omnihil {

struct Biquad {  // y = (b0 + b1/z + b2/z^2) / (1 + a1/z + a2/z^2) x
  double b0 = 1.0, b1 = 0.0, b2 = 0.0, a1 = 0.0, a2 = 0.0;
};

struct LowPass {
  std::vector<Biquad> sections;
  int order = 0;
};

LowPass butterworth(int order, double cutoff_Hz, double rate_Hz);

// Gain of zero_phase() at a share of half the rate, 0 to 1: that of one pass, squared.
double zero_phase_gain(const LowPass& filter, double share_of_nyquist);

// n samples to n samples, of x's unit.
std::vector<double> zero_phase(const LowPass& filter, std::span<const double> x);
// Every column of [n samples x m] by itself.
Eigen::MatrixXd zero_phase(const LowPass& filter, const Eigen::MatrixXd& columns);

// Slope per sample (x's unit) by central differences of the fourth order, one-sided at the ends; n samples to n. Gain over
// that of a slope: (8 sin w - sin 2w) / (6 w), w = 2 pi f T; 0.5 % are lost at a tenth of the rate.
std::vector<double> central_differences(std::span<const double> x);

}  // namespace omnihil
