// Noise of what was measured at settled points, which have no order: rows before and after a point say nothing of it.
//
//   double sigma_A = surface_noise(current_A, {speed_rad_s, load_Nm});
//
// Law: y = a + sum_j (b_j x_j + c_j |x_j| x_j + d_j sgn x_j) + sum_{j<l} e_jl x_j x_l + noise, by least squares; its sigma is that of
// the residuals by their median (statistics.h), times sqrt(n / (n - p)) for the p numbers fitted. In speed and load that is what a
// drive in good order takes: offset, load, viscous and dry friction, losses that rise with either, to second order.
// Validity: several rows per number, a signal that those variables make. An upper bound: what depends on other things (the
// angle), or is more bent, counts as noise.
#pragma once
#include <vector>

namespace omnihil {

// In the unit of y. Rows with a value that is not finite do not count. Infinity: too few rows.
double surface_noise(const std::vector<double>& y, const std::vector<std::vector<double>>& of);

}  // namespace omnihil
