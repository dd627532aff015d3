// Prediction of an axis' compared signals for one prepared run (axis_setup.h), for both scalars.
//
//   std::vector<std::vector<Jet>> y = axis_outputs<Jet>(setup, params, effects, 100e-6);
//
// Returns y[signal][sample], n samples each, in the units of AxisSetup::compared. Filters and level shifts
// that are linear in the signal are left to finish(), which takes values and derivatives alike.
#pragma once
#include "identify/predict/axis_setup.h"

namespace omnihil {

template <typename T>
std::vector<std::vector<T>> axis_outputs(const AxisSetup& setup, const DriveParams<T>& params,
                                         const EffectSet<T>& effects, double step_s);

// Zero-phase filter of the inverse method; mean of the bus voltage. `column`: n samples of one signal's
// values, or of their derivative after one unknown; `is_value`: shifts apply.
void finish(const AxisSetup& setup, std::size_t signal, bool is_value, Eigen::Ref<Eigen::VectorXd> column);

}  // namespace omnihil
