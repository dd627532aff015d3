// How far two signals are apart, over the samples that both have.
#pragma once
#include <cmath>
#include <vector>

namespace omnihil {

inline double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0.0, n = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (std::isfinite(a[k]) && std::isfinite(b[k])) square += (a[k] - b[k]) * (a[k] - b[k]), n += 1.0;
  }
  return std::sqrt(square / n);
}

}  // namespace omnihil
