// The physical terms from which a formula for unknown structure may be put together.
//
//   for (const UnknownTerm& t : torque_terms(model, scale, 0.01)) t.text;
//   // "omega_rotor_rad_s*abs(omega_rotor_rad_s)"
//
// Each is written in the variables of user formulas (`omnihil effects expression`), with the unit of what its
// coefficient must have and a coefficient at which it is of a visible size.
#pragma once
#include <string>
#include <vector>

#include "identify/select/effect_variants.h"

namespace omnihil {

struct UnknownTerm {
  std::string text;
  std::string unit;   // of its coefficient
  double size = 0.0;  // of its coefficient
  bool of_motor_torque = false;
};

// What adds to the rotor's torque; `torque_scale`: a torque that matters, N m (N).
std::vector<UnknownTerm> torque_terms(const Candidate& model, const DataScale& scale, double torque_scale);

// What adds to the winding's voltage; empty where the drive has no electrical part.
std::vector<UnknownTerm> voltage_terms(const Candidate& model, const DataScale& scale);

// "a*(term) + b*(term)" as an effect at these coefficients, each free to change its sign.
// Null where the formula cannot be made (a name that this rig does not have).
EffectUse formula_use(const std::string& name, const std::string& adds_to,
                      const std::vector<UnknownTerm>& terms, const std::vector<double>& coefficients,
                      bool linear);

}  // namespace omnihil
