// A diagnosis for people: verdict, what to add, how the errors fell, what to measure next; a page of text.
#pragma once
#include <string>

#include "identify/select/diagnosis.h"

namespace omnihil {

std::string diagnosis_text(const Diagnosis& diagnosis);

// "velocity rad/s   fit 3.10  held out 3.30  extrapolation 4.10": one line per signal
std::string errors_text(const Comparison& comparison);
// "velocity rad/s   fit 3.10 -> 0.40 …"
std::string errors_change_text(const Comparison& before, const Comparison& after);
// One line per parameter: value, interval, what to say of it; beside those that are among `of_file` (what the
// model file gives), how far they are from what it believes.
std::string parameters_text(const std::vector<ParameterEstimate>& parameters,
                            const std::vector<ParameterEstimate>& of_file);

}  // namespace omnihil
