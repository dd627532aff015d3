#include "hil/scenario/wheel_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace omnihil {
namespace {
using Speeds = std::array<double, kWheels>;
using Order = std::array<std::size_t, kWheels>;

double smallest_gap(Speeds wanted) {
  std::ranges::sort(wanted);
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < wanted.size(); ++i) gap = std::min(gap, wanted[i] - wanted[i - 1]);
  return gap;
}

Order nearest_order(const Speeds& speed, const Speeds& wanted) {
  Order order{0, 1, 2, 3}, best = order;
  double least = std::numeric_limits<double>::infinity();
  do {
    double sum = 0.0;
    for (std::size_t w = 0; w < order.size(); ++w) sum += std::pow(speed[w] - wanted[order[w]], 2);
    if (sum < least) least = sum, best = order;
  } while (std::ranges::next_permutation(order).found);
  return best;
}

// "wheels 1 and 2 are exchanged"; longer rounds as "wheel 0 turns at wheel 2's speed, …".
std::string rounds(const Order& order) {
  std::string pairs, rest;
  for (std::size_t w = 0; w < order.size(); ++w) {
    if (order[w] == w) continue;
    const bool pair = order[order[w]] == w;
    if (pair && order[w] > w) {
      pairs += fmt::format("{}wheels {} and {} are exchanged", pairs.empty() ? "" : ", ", w, order[w]);
    } else if (!pair) {
      rest += fmt::format("{}wheel {} turns at wheel {}'s speed", rest.empty() ? "" : ", ", w, order[w]);
    }
  }
  return pairs.empty() || rest.empty() ? pairs + rest : pairs + ", " + rest;
}
}  // namespace

WheelOrder wheel_order(const Speeds& speed, const Speeds& wanted) {
  constexpr double kApart_rad_s = 1e-3;
  const double gap = smallest_gap(wanted);
  if (gap < kApart_rad_s) {
    return {kWheels, "the command does not tell the wheels apart: four speeds of different size are needed"};
  }
  const Order order = nearest_order(speed, wanted);
  WheelOrder found;
  std::string off;
  for (std::size_t w = 0; w < order.size(); ++w) {
    const bool stray = std::abs(speed[w] - wanted[order[w]]) > gap / 2.0;
    found.out_of_place += stray || order[w] != w ? 1 : 0;
    if (stray)
      off += fmt::format("{}wheel {} turns at {:.4g} rad/s, which is asked of none", off.empty() ? "" : ", ",
                         w, speed[w]);
  }
  found.verdict = off.empty() ? rounds(order) : off;
  return found;
}

}  // namespace omnihil
