// Where a number of a model file came from: what was believed of it, and the fit that moved it since.
//
//   annotations_text(0.1, {.source = "data sheet"});
//   // ", tolerance = 0.1, source = \"data sheet\""
//   annotations_text(0.1, {.source = "data sheet", .fitted = {{.sigma = 0.003, .believed = 0.464}}});
//   // ", sigma = 0.003, source = \"fitted\", believed = { value = 0.464, tolerance = 0.1, source = … }"
//
// A fit starts from the value; its prior is the belief, however often the number was fitted. In memory the
// tolerance and the source of a number are always those of its belief.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace omnihil {

inline constexpr std::string_view kFittedSource = "fitted";

// A belief is given by its relative sigma (the tolerance, kept beside the number) or by an absolute one:
// that of an effect's strength, whose usual size is believed about zero.
struct FittedNumber {
  std::optional<double> sigma{};           // posterior, 1-sigma, in the number's unit; absent: not determined
  std::string data{};                      // fingerprint of the measurement: "sha256:" and 12 digits
  std::string date{};                      // "2026-11-23"
  std::optional<double> believed{};        // value of the belief; absent: nothing was believed
  std::optional<double> believed_sigma{};  // absolute 1-sigma of the belief, where it has no tolerance
};

// What a file says of a number beside its value.
struct NumberNote {
  std::string source{};                  // of the belief
  std::optional<FittedNumber> fitted{};  // absent: never fitted
};

// What stands behind the value within the braces: ", tolerance = 0.1, source = \"data sheet\""; "": nothing.
std::string annotations_text(std::optional<double> tolerance, const NumberNote& note);

}  // namespace omnihil
