// A tyre's curve (tyre.h) through points of force over slip that are uncertain in both.
//
//   TyreCurveFit f = fit_tyre_curve(points);
//   f.curve.extremum_slip;                     // start of the forward fit (tyre_identification.h)
//
// Minimises  sum Huber((ratio - grip(slip))^2 / (sigma_ratio^2 + grip'(slip)^2 sigma_slip^2 + s^2))  over the four numbers,
// the slope of the iteration before (effective variance; Orear 1982, Am. J. Phys. 50 (10)), from several slips of the
// extremum. s is 2 % of the largest ratio: what loads and friction, which are quasi-static laws, leave.
// Cannot: give errors of points that hang together; the forward fit does.
#pragma once
#include <span>

#include "identify/tyre/tyre_points.h"
#include "sim/robot/tyre.h"

namespace omnihil {

struct TyreCurveFit {
  TyreCurve curve;
  double chi2_per_point = 0.0;
};

TyreCurveFit fit_tyre_curve(std::span<const TyrePoint> points);

// What the wheels carry while they do not slide: for a tyre so stiff that its slip drowns in the noise.
struct StickingGrip {
  double most_ratio = 0.0;     // largest force over load, the mean of the best 0.2 %, ten points at least
  double slip_bound_95 = 0.0;  // slip there is less: mean + 1.645 of its standard error, R's error included
  int points = 0;
};
StickingGrip sticking_grip(const TyrePoints& points);

// Mean and its standard error in bins of slip, for the diagram.
struct TyreBin {
  double slip = 0.0, ratio = 0.0, ratio_error = 0.0;
  int points = 0;
};
std::vector<TyreBin> tyre_bins(std::span<const TyrePoint> points, int per_side = 24);

}  // namespace omnihil
