// What to measure next: the recording that parts the effects that could not be told apart, or shows what
// could not be seen.
//
//   diagnosis.next_experiment = next_experiment(dataset, diagnosis);
//
// The twins' own descriptions say what reveals each; the distance of their predictions is simulated by the
// designer of experiments (`omnihil experiment`), not here.
#pragma once
#include "identify/select/diagnosis.h"

namespace omnihil {

NextExperiment next_experiment(const Dataset& dataset, const Diagnosis& diagnosis);

}  // namespace omnihil
