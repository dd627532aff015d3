// Noise of what was measured at settled points, which have no order: rows before and after a point say nothing of it.
//
//   double sigma_A = surface_noise(current_A, {speed_rad_s, load_Nm});
//
// Law: y = a + sum_j (b_j x_j + c_j |x_j| x_j + d_j sgn x_j) + sum_{j<l} e_jl x_j x_l + noise, by least squares; its sigma is that of
// the residuals by their median (statistics.h), times sqrt(n / (n - p)) for the p numbers fitted. In speed and load that is what a
// drive in good order takes: offset, load, viscous and dry friction, losses that rise with either, to second order.
// A command has no noise, and its grid is no rounding: what scatters is the speed. It is known best from rows of one command,
// command_noise(duty, speed): the speeds' sigma there (of the differences of such rows, in order, by their median, over sqrt(2))
// times the slope of the command over the speed.
//
// Validity: five rows per number (with fewer, planes on either side of zero: a published table has a few dozen rows), a signal that
// those variables make. An upper bound: what depends on other things (the angle), or is more bent, counts as noise.
#pragma once
#include <vector>

namespace omnihil {

// In the unit of y. Rows with a value that is not finite do not count. Infinity: too few rows.
double surface_noise(const std::vector<double>& y, const std::vector<std::vector<double>>& of);

// In the unit of the command. Rows at rest do not count. Infinity: fewer than 20 pairs of rows of one command.
double command_noise(const std::vector<double>& command, const std::vector<double>& velocity);
// The command's change that moves the speed by one, by least squares over the rows that move; 0: none moves.
double command_slope(const std::vector<double>& command, const std::vector<double>& velocity);

}  // namespace omnihil
