// What to measure next: the recording that separates confounded effects, or excites one that was not visible.
//
//   diagnosis.next_experiment = next_experiment(dataset, diagnosis);
//
// Each effect's own page says which motion reveals it; the distance of the confounded effects' predictions is
// simulated by the design of experiments (`omnihil experiment`), not here.
#pragma once
#include "identify/select/diagnosis.h"

namespace omnihil {

NextExperiment next_experiment(const Dataset& dataset, const Diagnosis& diagnosis);

}  // namespace omnihil
