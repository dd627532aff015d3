// What the noise of a measured input makes of a signal that is differences of a position: the motion wanders beside the
// position's own rounding, and the filter that whitens both is another than that of the rounding alone.
//
//   const std::vector<Wander> wanders = {{.signal = &run.compared[0], .change = moved_minus_still}};    // one per run
//   const Whitening w = whitening_beside(wanders, 0.25, 0.125);          // w.time_constant_s: 0.125 to 0.25
//
// Law: of the leaks that whiten (predictor.h), halved from the longest on, the first through which the wander is no more than
// the rounding; the shortest if none is. The sigma is of both.
// Cannot: be white where rounding and wander have spectra that one time constant does not give (the leak of least variance,
// the prediction error's, is 4 to 8 ms then and takes the weight from slow errors, by which most effects are told); know a
// wander of anything but the input's noise. What is left the simulated null has as well (null_model.h).
#pragma once
#include <span>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

struct Wander {
  const ComparedSignal* signal = nullptr;  // a difference: whitening_s > 0
  std::vector<double> change;  // of its first samples, in its unit: with the input's noise less without
};

struct Whitening {
  double time_constant_s = 0.0;
  double sigma = 0.0;  // per sample of whitened(), of rounding and wander
};

// `wanders`: of one channel, at least one; its rounding is taken from noise_sigma.
Whitening whitening_beside(std::span<const Wander> wanders, double longest_s, double shortest_s);

}  // namespace omnihil
