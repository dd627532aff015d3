// The few settings of an effect that are tried before it is fitted: shapes on a small grid, strengths at a
// visible size, phases as pairs of sine and cosine.
//
//   for (const EffectVariant& v : variants_of(entry, candidate, scale)) {
//     for (const VariantColumn& c : v.columns) predictor.predict(with_use(candidate, setting(v, c)), run);
//     // a difference signal each; their linear coefficients give strengths and phases to start a refit from:
//     EffectUse start = start_of(v, coefficients, model);
//   }
//
// Law: A sin(n x + p) = A cos p sin(n x) + A sin p cos(n x), so a phase needs two difference signals and no
// search. Orders of cogging and torque ripple: least common multiple of poles and slots, their divisors and
// multiples, six per electrical turn, and what stands out in the residual's own order spectrum.
// Limits: shapes off the grid are found by the refit alone; a grid covers a factor of about 30.
#pragma once
#include <vector>

#include "identify/predict/candidate.h"

namespace omnihil {

// What the data cover: grids of shapes follow it.
struct DataScale {
  double top_speed_rad_s = 0.0;  // of the rotor; 0: unknown
  double top_current_A = 0.0;
  double duration_s = 0.0;       // of the longest run
  std::vector<double> orders{};  // per rotor turn, that stand out in the residual: strongest first
};

struct VariantColumn {
  int row = 0;         // the strength that is raised
  double size = 0.0;   // above its neutral value
  int phase_row = -1;  // set to `phase`; -1: none
  double phase = 0.0;
  bool two_sided = false;  // may be negative
};

struct EffectVariant {
  EffectUse shape;  // strengths neutral, shapes as tried
  std::vector<VariantColumn> columns;
};

// Of a strength, from neutral, in this drive.
double visible_size(const EffectParam& row, const Candidate& candidate);

std::vector<EffectVariant> variants_of(const EffectEntry& entry, const Candidate& candidate,
                                       const DataScale& scale);

// Further strengths (details) of an effect that the candidate has: harmonics of cogging, the housing behind a
// winding. `shape` is the use as it is in the candidate.
std::vector<EffectVariant> extensions_of(const EffectUse& use, const Candidate& candidate,
                                         const DataScale& scale);

// An effect with a series of harmonics (cogging), at several orders at once: order = their greatest common
// divisor, one harmonic each. Empty where it has none, where there are fewer than two orders, or their common
// divisor is too small for the harmonics there are.
std::vector<EffectVariant> series_variants(const EffectEntry& entry, const Candidate& candidate,
                                           const DataScale& scale);

// Its strengths `factor` times as large, the shapes that follow them (EffectParam::power_of_size) moved along.
EffectVariant with_size(EffectVariant variant, double factor);

EffectUse setting(const EffectVariant& variant, const VariantColumn& column);
// `coefficients`: multiples of the columns' sizes that fit best. Kept within the rows' bounds.
EffectUse start_of(const EffectVariant& variant, const std::vector<double>& coefficients,
                   const Candidate& model);

// The candidate with this effect in the place that its id has; one of the same name is replaced.
Candidate with_use(const Candidate& candidate, const EffectUse& use);

}  // namespace omnihil
