// Do rows that lie apart in time still know where the shaft is within a period of a law of its angle (cogging,
// ripple, an eccentric load)?
//
//   const AngleDrift drift = angle_drift(residuals, model, 3.0);   // 3 rad/s: error of the speed
//   unresolved_share(use, drift, signal);     // 0.9: nearly all of the signal lies in rows that do not
//
// Where no sensor reports the angle it is the integral of the model's speed, and from one row to the next it is off
// by that speed's error times the time between them. From half a period on the phase is unknown at every row anew:
// what a periodic law does then is a mean, which any law without an angle gives as well.
// Limits: order 1 for laws without a row of that kind (gravity, imbalance); the drift over many rows is not
// counted. Robots, points of a steady map: nothing is unresolved.
#pragma once
#include <Eigen/Core>

#include "identify/estimate/whitened_residuals.h"
#include "identify/predict/candidate.h"

namespace omnihil {

// Size n (samples of the split), rad: error of the model's angle that comes in since the sample before; 0: none.
struct AngleDrift {
  Eigen::VectorXd rotor_rad, output_rad;
};
// `speed_error_rad_s`: of the output shaft; 0: the angle is measured, or the error is not known.
AngleDrift angle_drift(const WhitenedResiduals& residuals, const Candidate& model, double speed_error_rad_s);

// Share of the signal's energy (size n) in samples whose angle is off by half a period of the law, or more; 0 for
// laws that do not depend on the angle.
double unresolved_share(const EffectUse& use, const AngleDrift& drift, const Eigen::VectorXd& signal);

}  // namespace omnihil
