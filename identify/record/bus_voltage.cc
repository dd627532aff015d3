#include "identify/record/bus_voltage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace omnihil {

std::vector<double> plausible_bus_voltage(std::vector<double> measured_V) {
  constexpr double kHighest = 1.5;  // of the run's median
  std::vector<double> known;
  for (const double v : measured_V) {
    if (std::isfinite(v)) known.push_back(v);
  }
  if (known.empty()) return measured_V;
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  if (*middle <= 0.0) return measured_V;
  for (double& v : measured_V) {
    if (v > kHighest * *middle) v = std::numeric_limits<double>::quiet_NaN();
  }
  return measured_V;
}

}  // namespace omnihil
