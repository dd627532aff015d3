// A model under test: base parameters, effects, and which of their numbers a fit may move.
//
//   Candidate c = …;                                            // from the nominal model file
//   std::vector<Unknown> u = unknowns_of(c);                    // R, k, J, b, …, cogging.amplitude_Nm, …
//   Candidate moved = with_values(c, u, x);
//
// A base number is an unknown when its file gives it a tolerance (its prior: normal, relative 1-sigma; cut to
// the row's bounds); a bare number is known exactly. Of an effect every strength is an unknown, a shape where
// it has a range to move in, a detail only where it is not neutral. Priors of effects: effect.h.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/core/effect_set.h"
#include "sim/core/model_file.h"
#include "sim/drive/drive_params.h"

namespace omnihil {

struct Candidate {
  ModelFile file;                  // its parameter table holds the base numbers
  std::vector<EffectUse> effects;  // coulomb_friction among them, where the file has it
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
  double prior_sigma = 0.0;  // 0: flat within the bounds
  double scale = 1.0;        // a step that matters: tolerance * value, or the effect's typical size
};

// Effects by id; of a formula "expression.NAME".
std::string effect_name(const EffectUse& use);

std::vector<Unknown> unknowns_of(const Candidate& candidate);

Candidate with_values(const Candidate& candidate, std::span<const Unknown> unknowns,
                      std::span<const double> values);

// The candidate with what a run knows of itself (Run::known) put in; a known number is no unknown there.
Candidate with_known(const Candidate& candidate, std::span<const std::pair<std::string, double>> known);

// With one more effect, all its strengths neutral.
Candidate with_effect(const Candidate& candidate, const EffectEntry& entry);
Candidate without_effect(const Candidate& candidate, std::string_view name);

// Numbers of the drive, for a rig "axis".
DriveParams<double> drive_of(const Candidate& candidate);

// Text of a model file (omnihil-model/1) with these numbers; tolerances and sources kept.
std::string candidate_text(const Candidate& candidate);

}  // namespace omnihil
