#include "sim/bench/excitation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr std::array<std::string_view, 5> kNames = {"steps", "ramp", "chirp", "prbs", "creep"};
constexpr std::array<double, 12> kLevels = {0.0, 0.5, 1.0, 0.3, -0.2, -1.0, -0.5, 0.1, 0.7, -0.7, 0.2, -0.1};
constexpr double kLevelHold_s = 0.4, kBitHold_s = 0.02;
constexpr double kChirpFrom_Hz = 0.2, kChirpTo_Hz = 40.0;
constexpr double kCreepScale = 0.1, kCreepPeriod_s = 16.0;

// 0 at 0, 1 at a quarter, -1 at three quarters of the period
double triangle(double turns) {
  const double x = turns - std::floor(turns);
  return x < 0.25 ? 4.0 * x : (x < 0.75 ? 2.0 - 4.0 * x : 4.0 * x - 4.0);
}

}  // namespace

std::span<const std::string_view> excitation_names() { return kNames; }

std::optional<Excitation> find_excitation(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Excitation>(found - kNames.begin());
}

double excitation_at(Excitation kind, double time_s, const ExcitationOptions& options) {
  // The small push keeps a change at a multiple of the hold time at its own sample in spite of rounding.
  const auto portion = [&](double hold_s) { return static_cast<std::uint64_t>(time_s / hold_s + 1e-6); };
  switch (kind) {
    case Excitation::kSteps:
      return kLevels[(portion(kLevelHold_s) + options.seed) % kLevels.size()];
    case Excitation::kRamp:
      return triangle(2.0 * time_s / options.duration_s);
    case Excitation::kChirp: {
      // phase = 2 pi f0 T / ln(f1/f0) ((f1/f0)^(t/T) - 1)
      const double growth = std::log(kChirpTo_Hz / kChirpFrom_Hz);
      return std::sin(2.0 * std::numbers::pi * kChirpFrom_Hz * options.duration_s / growth *
                      std::expm1(growth * time_s / options.duration_s));
    }
    case Excitation::kPrbs:
      return (random_bits(options.seed, stream_of("prbs"), portion(kBitHold_s)) & 1u) != 0 ? 1.0 : -1.0;
    case Excitation::kCreep:
      return kCreepScale * triangle(time_s / kCreepPeriod_s);
  }
  return 0.0;
}

}  // namespace omnihil
