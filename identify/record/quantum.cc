#include "identify/record/quantum.h"

#include <algorithm>
#include <cmath>

namespace omnihil {

double quantum_of(std::vector<double> v) {
  std::erase_if(v, [](double x) { return !std::isfinite(x); });
  if (v.empty()) return 0.0;
  std::sort(v.begin(), v.end());
  const double range = v.back() - v.front();
  const double least =
      1e-7 * range;  // differences below are rounding of one value (seven digits of a CSV file)
  double smallest = range;
  std::size_t different = 1;
  for (std::size_t i = 1; i < v.size(); ++i) {
    const double step = v[i] - v[i - 1];
    if (step <= least) continue;
    ++different;
    smallest = std::min(smallest, step);
  }
  return different * 3 < v.size() && different > 1 ? smallest : 0.0;
}

}  // namespace omnihil
