// Every q-th sample of a record, low-passed before without delay: Chebyshev of order 8, forward and backward.
//
//   std::vector<double> slow = decimate(force, 10);          // 1 kHz -> 100 Hz
//
// Law: type I, ripple 0.05 dB, edge at 0.8 of the new Nyquist frequency; poles -sinh(m) sin(t_k) + i cosh(m)
// cos(t_k), m = asinh(1/eps) / n, t_k = (2k - 1) pi / 2n, eps^2 = 10^(ripple/10) - 1; bilinear transform with
// prewarped edge (Oppenheim, Schafer, Discrete-Time Signal Processing, ch. 7; the usual tools' `decimate`).
// An even order's gain at zero frequency is the ripple's lower edge, 0.99426 per pass.
// Validity: evenly spaced samples without gaps.
#pragma once
#include <span>
#include <vector>

#include "identify/record/filter.h"

namespace omnihil {

// Frequencies in any one unit; ripple in dB, peak to peak of the pass band.
LowPass chebyshev(int order, double ripple_dB, double edge_Hz, double rate_Hz);

// n samples to ceil(n / factor), of x's unit: those of index 0, factor, 2 factor, … of the filtered record.
std::vector<double> decimate(std::span<const double> x, int factor);

}  // namespace omnihil
