// One parameter of an effect: a row of its table, with all that reading, fitting and searching must know of it.
//
//   constexpr EffectParam row{
//       .name = "speed_rad_s", .unit = "rad/s", .role = ParamRole::kShape, .neutral = kNoNeutral,
//       .typical = 5, .lower = 0.05, .upper = 500, .prior_scale = 10,
//       .what = "speed at which the extra has fallen to 1/e", .how = "steady current at many low speeds",
//       .grid = {GridOf::kTopSpeed, {0.01, 0.04, 0.15}}};
//
// What is said here is said nowhere else: no code knows a row by its name.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

namespace omnihil {

template <typename T>
struct DriveParams;  // sim/law/drive_params.h

// What a parameter is to its effect.
enum class ParamRole : std::uint8_t {
  kStrength,  // at its neutral value the effect is exactly absent (all strengths and details at neutral)
  kShape,     // no effect of its own: order, phase, width
  kDetail,    // a further strength that stays at neutral unless it is asked for (a second harmonic)
};

// What kind of number it is, where that decides how it is treated.
enum class ParamTrait : std::uint8_t {
  kPlain,
  kPeriodic,  // an angle that goes round: no bound of it means anything; taken as sine and cosine of a strength
  kOrder,     // periods in a turn: whole by the make of the thing, found in the residual's own order spectrum
  kCount,     // another number that is whole by the make of the thing (pulses in a turn): never fitted
  kForm,      // a form of the law (an exponent): at a bound it is the neighbouring form, not a symptom
  // What may be next to none: a width within which a sign turns over, a loss beside the bearings' own. Its lower bound is the law
  // without it, below what the data resolve, and no symptom.
  kSmoothing,
  kTime,     // a time, or in proportion to one: below a share of the sampling period it is lost in the clock
  kDamping,  // friction in proportion to speed: what the gain of a closed speed loop looks like
};

// What the values that a search tries are multiples of.
enum class GridOf : std::uint8_t {
  kStart,        // the start value of a shape, the visible size of a strength
  kStartInTime,  // the same, in a record of some duration: settled points say nothing of what takes time
  kTopSpeed,     // the rotor's largest speed in the data
  kTopCurrent,   // the largest current in the data
  kAbsolute,     // 1: the values as they stand
};

struct SearchGrid {
  GridOf of = GridOf::kStart;
  std::array<double, 6> at{};  // as many as are not 0; none: the start value alone
};

// Of an order: the rows that hold strength (and phase, if its row follows) at 2, 3, … times it.
struct HarmonicSeries {
  int first_row = 0;
  int stride = 0;  // rows from one harmonic to the next
  int count = 0;   // 0: no series
};

inline constexpr double kNoNeutral =
    std::numeric_limits<double>::quiet_NaN();  // compile-time mark of shape rows

struct EffectParam {
  std::string_view name;  // the unit is its suffix
  std::string_view unit;  // "N m"; "1": a ratio
  ParamRole role = ParamRole::kStrength;
  double neutral = 0.0;  // kStrength and kDetail
  double typical = 0.0;  // a visible size, used by documentation and tests; start value of a shape
  double lower = 0.0;
  double upper = 0.0;
  // Prior of a fit: half-normal (normal if the bounds straddle neutral) of this scale about neutral, with
  // finite density there; a shape's is normal about its start value. 0: flat within the bounds.
  double prior_scale = 0.0;
  std::string_view what;  // one line
  std::string_view how;   // how to measure it
  // Start value of a shape, visible size of a strength, from the motor at hand (a cogging order from poles
  // and slots, the compliance that rings at some frequency); null: `typical`.
  double (*start_for)(const DriveParams<double>&) = nullptr;
  ParamTrait trait = ParamTrait::kPlain;
  SearchGrid grid{};
  // Of a shape: it goes with this power of the further sizes that the strength is tried at.
  double power_of_size = 0.0;
  HarmonicSeries series{};  // kOrder
  int wheel = 0;  // of a row that is a wheel's: 1, 2 … as many as a robot may have; they stand last
};

constexpr bool is_whole(const EffectParam& row) {
  return row.trait == ParamTrait::kOrder || row.trait == ParamTrait::kCount;
}

// Harmonic k = 2 … count + 1: the row of its strength.
constexpr std::size_t harmonic_row(const HarmonicSeries& series, int k) {
  return static_cast<std::size_t>(series.first_row + series.stride * (k - 2));
}
// The harmonic whose strength a row holds; 0: none.
constexpr int harmonic_of(const HarmonicSeries& series, std::size_t row) {
  for (int k = 2; k <= series.count + 1; ++k) {
    if (harmonic_row(series, k) == row) return k;
  }
  return 0;
}

// Rows that several effects have alike, with what differs: a law A sin(n x + p) has these two.
constexpr EffectParam order_row(double typical, double upper, std::string_view what, std::string_view how,
                                double (*start_for)(const DriveParams<double>&) = nullptr,
                                HarmonicSeries series = {}) {
  return {.name = "order",
          .unit = "1",
          .role = ParamRole::kShape,
          .neutral = kNoNeutral,
          .typical = typical,
          .lower = 1,
          .upper = upper,
          .what = what,
          .how = how,
          .start_for = start_for,
          .trait = ParamTrait::kOrder,
          .series = series};
}
// Once round either way, and a little more, so that a fit that starts at half a turn is free on both sides.
constexpr EffectParam phase_row(std::string_view what, std::string_view how,
                                std::string_view name = "phase_rad", double typical = 0.0) {
  return {.name = name,
          .unit = "rad",
          .role = ParamRole::kShape,
          .neutral = kNoNeutral,
          .typical = typical,
          .lower = -6.3,
          .upper = 6.3,
          .what = what,
          .how = how,
          .trait = ParamTrait::kPeriodic};
}

}  // namespace omnihil
