// How much stronger a drive is than those that the catalogue's usual torques are of.
//
//   nominal.torque_scale = torque_scale_of(dataset, nominal);   // an arm driven with 30 N m rms: 300
//
// The usual sizes and priors of effects (coulomb_friction 3 mN m, within 10 mN m) are those of a robot's wheel
// motors. Friction, gravity and ripple grow with the drive they are of, so on a bench that says what torque it
// asked for they are taken in proportion to it, on one that is asked for a voltage or a duty in proportion to what the
// drive could do at standstill, k U / R; never smaller than in the catalogue. A linear axis has its own (linear_scale.h).
#pragma once
#include "identify/predict/candidate.h"
#include "identify/record/dataset.h"

namespace omnihil {

double torque_scale_of(const Dataset& dataset, const Candidate& nominal);  // 1 to kStrongestDrive

}  // namespace omnihil
