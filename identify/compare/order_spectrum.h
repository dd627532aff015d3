// Which orders (periods per rotor turn) stand out in a residual.
//
//   std::vector<OrderPeak> p = strong_orders(predictor, residuals, model, weighted_residual, 4);
//   p[0].order;        // 48
//
// A torque A sin(n theta + p) appears in the speed behind the drive's own lag T = J / (k^2/R + b); sine and
// cosine of every whole order are sent through that lag and held against the residual (least squares, two
// coefficients per order and signal). The strongest is taken out, then the next is looked for, while one
// stands out from its neighbours by far. Where the drive input is compared (inverse method) there is no lag.
// Cannot: separate orders that never passed at different speeds; find orders that pass faster than a third
// of the sampling rate; fractions of an order.
#pragma once
#include <vector>

#include "identify/estimate/whitened_residuals.h"

namespace omnihil {

struct OrderPeak {
  double order = 0.0;
  double share = 0.0;  // of the residual's energy when it was taken out
};

// At most `most`, strongest first. `weighted_residual`: n = residuals.size() samples, whitened and divided by
// their channel's scale (WhitenedResiduals::weights), of no unit. Empty where the rotor's angle is not known.
std::vector<OrderPeak> strong_orders(const Predictor& predictor, const WhitenedResiduals& residuals,
                                     const Candidate& model, Eigen::VectorXd weighted_residual, int most);

}  // namespace omnihil
