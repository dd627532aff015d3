// A model under test: base parameters, effects, and which of their parameters are unknowns of a fit.
//
//   Candidate c = …;                                            // from the nominal model file
//   std::vector<Unknown> u = unknowns_of(c);                    // R, k, J, b, …, cogging.amplitude_Nm, …
//   Candidate moved = with_values(c, u, x);
//
// A base parameter is an unknown if its file gives it a tolerance (prior: normal, relative 1-sigma, truncated
// to the row's bounds); without one it is known exactly. Strengths and shapes of an effect in a file
// likewise. Of an effect that the program has added, unknowns are: every strength; a shape whose range is not
// empty; a detail that is not neutral. Never: a parameter with a tolerance of 0 in its file, and a shape that
// is an integer by construction (orders, pulses per turn: flat from 1 on). Priors of effects: effect.h, or
// the file's tolerance where it gives one. The prior of a number that was fitted before is what was believed
// then (fitted_number.h), and it starts where that fit ended. Values are in the unknowns' own units.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "identify/predict/prior.h"
#include "sim/law/drive_params.h"
#include "sim/law/effect_set.h"
#include "sim/law/param_range.h"
#include "sim/model/model_file.h"

namespace omnihil {

struct Candidate {
  ModelFile file;                  // its parameter table holds the base parameters
  std::vector<EffectUse> effects;  // coulomb_friction among them, where the file has it
  double torque_scale = 1.0;       // of the catalogue's torques: torque_scale.h
};

struct Unknown {
  std::string path;  // "motor.resistance_ohm"; "cogging.amplitude_Nm"; "expression.drag.a"
  std::string unit;
  int effect = -1;  // index into Candidate::effects; -1: a base parameter
  int row = 0;      // of the effect's parameters
  double start = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  double prior_mean = 0.0;
  double prior_sigma = 0.0;  // tolerance * value; 0: flat within the bounds
  PriorForm prior_form = PriorForm::kNormal;
  double scale = 1.0;  // a step that matters: tolerance * value, or the effect's typical size
  ParamTrait trait = ParamTrait::kPlain;
};

// Bounds and scales of an effect's parameter on the drive that this is a model of.
ParamRange param_range(const EffectParam& row, const Candidate& of);

// From what the readers of a model file give. A robot's coulomb_friction, a base parameter elsewhere, is an
// effect here.
Candidate candidate_of(ModelFile file, std::vector<EffectUse> effects);
Candidate candidate_of(const ModelFile& robot);

// Effects by id; of a formula "expression.NAME".
std::string effect_name(const EffectUse& use);

std::vector<Unknown> unknowns_of(const Candidate& candidate);  // p of them: base parameters first

Candidate with_values(const Candidate& candidate, std::span<const Unknown> unknowns,
                      std::span<const double> values);

// One parameter by path, of the base or of an effect ("cogging.amplitude_Nm", also with "effects." before
// it). set_value: "" or what is wrong; bounds are held.
std::optional<double> value_at(const Candidate& candidate, std::string_view path);
std::string set_value(Candidate& candidate, std::string_view path, double value);

// The candidate with the parameters that a run states (Run::known) put in; those are no unknowns there. What
// set_value refuses is left as it was: the dataset's reader has said so.
Candidate with_known(const Candidate& candidate, std::span<const std::pair<std::string, double>> known);

// How many wheels its robot has; kAllWheels: it has none.
std::size_t wheels_of(const Candidate& candidate);
// An effect with its strengths neutral and its shapes at their starts, in this drive, on these wheels.
EffectUse neutral_use(const EffectEntry& entry, const Candidate& of);

// With one more effect, all its strengths neutral.
Candidate with_effect(const Candidate& candidate, const EffectEntry& entry);
Candidate with_effect(const Candidate& candidate, EffectUse use);  // a user's formula
Candidate without_effect(const Candidate& candidate, std::string_view name);
// The effect of that id, as the model has it; null: it has none.
const EffectUse* use_of(const Candidate& candidate, std::string_view id);

// Parameters of the drive: a rig "axis", or one wheel of a robot, lifted. Without coulomb_friction, which is
// among the effects.
DriveParams<double> drive_of(const Candidate& candidate);
// A rig "robot", with the parameters of its table and all effects in their places (coulomb_friction in its
// motor).
RobotModel robot_of(const Candidate& candidate);

// Notes on one number, by path as above, that a fit gave it its value; a path there is not is left out. The
// belief's tolerance and source stay as they are.
void note_fit(Candidate& candidate, std::string_view path, const FittedNumber& fit);

// Text of a model file (omnihil-model/1) with these parameters; beliefs and fits kept.
std::string candidate_text(const Candidate& candidate);

}  // namespace omnihil
