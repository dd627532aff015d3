// What to ask of a drive so that something shows: values in -1 … 1 over time, to be scaled by the caller.
//
//   double duty = 0.6 * excitation_at(Excitation::kChirp, t, {.duration_s = 20});
//
//   steps   a fixed pattern of levels, 0.4 s each, both signs, small and large   for transients, delays
//   ramp    triangle from 0 to 1 to -1 to 0, twice over the duration             for friction, limits, asymmetry
//   chirp   sine from 0.2 Hz to 40 Hz, exponentially                             for inductance, delays, resonance
//   prbs    one of -1, 1 for multiples of 20 ms                                  for fits in general
//   creep   triangle of a tenth of full scale, 16 s per period                   for friction at rest, cogging
//
// Source: Ljung, System Identification, 2nd ed. 1999 (inputs).
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace omnihil {

enum class Excitation : std::uint8_t { kSteps, kRamp, kChirp, kPrbs, kCreep };

struct ExcitationOptions {
  double duration_s = 20.0;
  std::uint64_t seed = 0;  // shifts the pattern of steps, draws the signs of prbs
};

std::span<const std::string_view> excitation_names();
std::optional<Excitation> find_excitation(std::string_view name);
double excitation_at(Excitation kind, double time_s, const ExcitationOptions& options);

}  // namespace omnihil
