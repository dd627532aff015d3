// Do rows that lie apart in time still know where the shaft is within a period of a law of its angle (cogging,
// ripple, an eccentric load)?
//
//   const AngleDrift drift = angle_drift(residuals, model, 3.0);   // 3 rad/s: error of the speed
//   unresolved_share(use, drift, signal);     // 0.9: nearly all of the signal lies in rows that do not
//   why_not(*use.entry, predictor, dataset);  // "needs encoders: …", where no row does
//
// Where no sensor reports the angle it is the integral of the model's speed, and from one row to the next it is off
// by that speed's error times the time between them. From half a period on the phase is unknown at every row anew:
// what a periodic law does then is a mean, which any law without an angle gives as well. On a robot each run begins at
// wheel angles that only encoders know, and wheels slip: the drift is infinite from the first row on.
// Limits: order 1 for laws without a row of that kind (gravity, imbalance); the drift over many rows is not
// counted, nor that a run of an axis may begin at another angle. Points of a steady map: nothing is unresolved.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>

#include "identify/estimate/whitened_residuals.h"
#include "identify/predict/candidate.h"

namespace omnihil {

// What tells the angle of shaft or wheels in these data.
enum class AngleSource : std::uint8_t {
  kSensor,
  kSpeed,  // its integral, from where the run began
  kNone,
};
AngleSource angle_source(const Dataset& dataset);

// Size n (samples of the split), rad: error of the model's angle that comes in since the sample before; 0: none.
struct AngleDrift {
  Eigen::VectorXd rotor_rad, output_rad;
};
// `speed_error_rad_s`: of the output shaft; 0: the angle is measured, or the error is not known; infinite: nothing
// tells the angle.
AngleDrift angle_drift(const WhitenedResiduals& residuals, const Candidate& model, double speed_error_rad_s);

// Share of the signal's energy (size n) in samples whose angle is off by half a period of the law, or more; 0 for
// laws that do not depend on the angle.
double unresolved_share(const EffectUse& use, const AngleDrift& drift, const Eigen::VectorXd& signal);
// Is it all of it, whatever the signal and the order?
bool is_never_resolved(const EffectInfo& info, const AngleDrift& drift);

// For people: of what rows lie too far apart for, and of what no row tells.
inline constexpr std::string_view kPhaseUnresolved =
    "not visible in these data: no sensor reports the angle, and from one row to the next the model's is "
    "off by more than half a period";
inline constexpr std::string_view kNoPhase = "needs encoders: its phase is that of an angle";
// Does no row of these data tell the law's phase?
bool lacks_phase(const EffectInfo& info, const Dataset& dataset);
// Why an effect cannot act here (Predictor::applies), or not be told; "": it can.
std::string why_not(const EffectEntry& entry, const Predictor& predictor, const Dataset& dataset);

}  // namespace omnihil
