// The model of an axis run on one prepared run (axis_setup.h), signal by signal, for both scalars.
//
//   std::vector<std::vector<Jet>> y = axis_outputs<Jet>(setup, params, effects, 100e-6);
//
// Filters and level shifts that are linear in the signal are left to finish(), which takes values and
// derivatives alike.
#pragma once
#include "identify/predict/axis_setup.h"

namespace omnihil {

template <typename T>
std::vector<std::vector<T>> axis_outputs(const AxisSetup& setup, const DriveParams<T>& params,
                                         const EffectSet<T>& effects, double step_s);

// Zero-phase filter of the inverse method; mean of the bus voltage. `column` is one signal's values or one of
// its derivatives; `is_value`: shifts apply.
void finish(const AxisSetup& setup, std::size_t signal, bool is_value, Eigen::Ref<Eigen::VectorXd> column);

}  // namespace omnihil
