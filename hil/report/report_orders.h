// How strong a residual is at each order of an angle: order 1 is once per turn, 12 is twelve times.
//
//   OrderSums s = order_sums(angle_rad, residual, 192);
//   s.power[71] / s.weight[71];      // squared amplitude at order 72
//
// Law: A_n = 2 |sum w r exp(-j n theta)| / sum w with w = |d theta|, the mean of r taken off; so a slow turn
// counts as much as a fast one. Valid while n |d theta| stays below half a period; samples beyond that are
// left out of order n. Cannot tell a residual that is periodic in time from one periodic in angle when the
// speed never changes.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace omnihil {

struct OrderSums {
  double turns = 0.0;
  std::vector<double> power;   // per order: amplitude squared times turned angle
  std::vector<double> weight;  // per order: turned angle, rad
};

// NaN in either is left out. The angle may be wrapped to a turn or not.
OrderSums order_sums(std::span<const double> angle_rad, std::span<const double> residual, std::size_t orders);

// Three times the median: what an order must pass to stand out of the others.
double order_floor(const std::vector<double>& amplitude);

}  // namespace omnihil
