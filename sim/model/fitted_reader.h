// Reads the record of a fit on a number of a model file: sigma, data, date and believed (fitted_number.h).
//
//   NumberBelief belief;
//   read_fitted(document, "motor.resistance_ohm", number, rule, belief, problems);
//   belief.tolerance; belief.note.fitted->believed;
//
// Those keys stand only beside source = "fitted", and tolerance not beside them: the tolerance of a fitted
// number is its belief's. Problems name file, line and column.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/law/fitted_number.h"
#include "sim/model/model_document.h"

namespace omnihil {

struct NumberBelief {
  std::optional<double> tolerance{};
  NumberNote note{};
};

struct BeliefRule {
  std::string range{};                   // what is allowed, for messages
  std::function<bool(double)> within{};  // is this value allowed
  bool absolute_sigma = false;           // may the belief have a sigma in the number's unit (an effect's)
};

bool is_fit_key(std::string_view key);
// Has the number a record of a fit?
bool has_fit_key(const toml::table& number);

// `belief` keeps what it is where the table has no such key.
void read_fitted(const ModelDocument& document, const std::string& path, const toml::table& number,
                 const BeliefRule& rule, NumberBelief& belief, std::vector<ModelProblem>& problems);

// A tolerance of a file: relative 1-sigma.
inline constexpr double kLargestTolerance = 10.0;  // a choice: ten times the value is no belief any more

}  // namespace omnihil
