// What a team's firmware in the predictions costs, said on stderr: it is of wall time, and no result.
//
//   FirmwareMeter meter(*reading.dataset);
//   say_firmware_ahead("fit", meter, *predictor, *reading.nominal, unknowns.size());
//   …;
//   say_firmware_cost("fit", meter);
//
// Both are silent where the dataset has no firmware.
#pragma once
#include <cstddef>

#include "hil/dataset/firmware_meter.h"
#include "identify/predict/predictor.h"

namespace omnihil {

// One simulation of the runs to fit, timed; what a step of a fit with so many numbers takes.
void say_firmware_ahead(const char* verb, const FirmwareMeter& meter, const Predictor& predictor,
                        const Candidate& candidate, std::size_t numbers);
// How many there were, how long they took, how many failed and why.
void say_firmware_cost(const char* verb, const FirmwareMeter& meter);

}  // namespace omnihil
