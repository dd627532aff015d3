#include "protocols/scale_rules.h"

#include <cmath>

namespace omnihil {
namespace {

struct Counts {
  std::int64_t lowest;
  std::int64_t highest;
};
Counts counts_of(const Field& field) {
  const std::int64_t half = std::int64_t{1} << (field.bits - 1);
  if (field.sign == Sign::kNone) return {0, 2 * half - 1};
  return {field.sign == Sign::kMagnitude ? 1 - half : -half, half - 1};
}

double step_of(const Field& field) { return field.hi / static_cast<double>(counts_of(field).highest); }

// number = lo + (hi - lo) (count - lowest) / (highest - lowest), every step in float32
double even_number(const Field& field, std::int64_t count) {
  const Counts counts = counts_of(field);
  const auto lo = static_cast<float>(field.lo);
  const float span = static_cast<float>(field.hi) - lo;
  const float above = static_cast<float>(count) - static_cast<float>(counts.lowest);
  const float all = static_cast<float>(counts.highest) - static_cast<float>(counts.lowest);
  const float product = span * above;
  const float share = product / all;
  return lo + share;
}

// count = round(lowest + (highest - lowest) (x - lo) / (hi - lo) + bias); halves go away from 0, and the bias of a
// signed field brings 0, which lies between two counts, to count 0
std::int64_t even_count(const Field& field, double number) {
  const Counts counts = counts_of(field);
  const double lo = static_cast<float>(field.lo);
  const double span = static_cast<float>(field.hi) - lo;
  const double bias = field.sign == Sign::kNone ? 0.0 : 1e-8;
  const auto lowest = static_cast<double>(counts.lowest);
  const double all = static_cast<double>(counts.highest) - lowest;
  const double number32 = static_cast<float>(number);
  const auto count = static_cast<std::int64_t>(std::round(lowest + all * (number32 - lo) / span + bias));
  return count < counts.lowest ? counts.lowest : count > counts.highest ? counts.highest : count;
}

// counts per unit: highest / hi
float per_unit(const Field& field) {
  return static_cast<float>(static_cast<double>(counts_of(field).highest) / field.hi);
}
double truncated_number(const Field& field, std::int64_t count) {
  const float number = static_cast<float>(count) / per_unit(field);
  return number;
}
// count = trunc(highest / hi * x), not beyond the field; the ends to the nearest
std::int64_t truncated_count(const Field& field, double number) {
  const Counts counts = counts_of(field);
  const auto number32 = static_cast<float>(number);
  if (number32 == static_cast<float>(field.lo) || number32 == static_cast<float>(field.hi)) {
    return std::llround(number * static_cast<double>(counts.highest) / field.hi);
  }
  const float product = number32 * per_unit(field);
  const auto count = static_cast<std::int64_t>(product);
  return count < counts.lowest ? counts.lowest : count > counts.highest ? counts.highest : count;
}

constexpr std::string_view kTruncatedSays = "count = trunc(highest / hi x) in float32";
constexpr std::string_view kEvenSays =
    "count = round(lowest + (highest - lowest) (x - lo) / (hi - lo)), and 1e-8 more in the bracket where it "
    "has a "
    "sign; back in float32";
constexpr float kHalf = 32767.0F;

}  // namespace

const ScaleRule kNearest{
    .name = "nearest",
    .says = "count to the nearest",
    .number = [](const Field& field,
                 std::int64_t count) { return static_cast<double>(count) * step_of(field); },
    .count = [](const Field& field,
                double number) { return static_cast<std::int64_t>(std::llround(number / step_of(field))); },
};
const ScaleRule kWhole{
    .name = "whole",
    .says = "count = trunc(x)",
    .number = [](const Field&, std::int64_t count) { return static_cast<double>(count); },
    .count = [](const Field&, double number) { return static_cast<std::int64_t>(number); },
    .beyond = Beyond::kClamped,
};
// The levels begin at 0.2, 0.533 and 0.867.
const ScaleRule kThirds{
    .name = "thirds",
    .says = "level = trunc(3 x + 0.4)",
    .number = [](const Field&, std::int64_t count) { return static_cast<double>(count) / 3.0; },
    .count = [](const Field&, double number) { return static_cast<std::int64_t>(3.0 * number + 0.4); },
    .beyond = Beyond::kClamped,
};
// All in float32; a field's `hi` is its range.
const ScaleRule kAroundHalf{
    .name = "around-half",
    .says = "count = trunc(32767 x / range + 32767) in float32",
    .number = [](const Field& field, std::int64_t count) -> double {
      const float share = static_cast<float>(count - 32767) / kHalf;
      return share * static_cast<float>(field.hi);
    },
    .count =
        [](const Field& field, double number) {
          const float scaled = kHalf * static_cast<float>(number) / static_cast<float>(field.hi);
          return static_cast<std::int64_t>(scaled + kHalf);
        },
};
const ScaleRule kTwentieths{
    .name = "twentieths",
    .says = "count = trunc(20 x) in float32",
    .number = [](const Field&, std::int64_t count) -> double { return static_cast<float>(count) / 20.0F; },
    .count = [](const Field&,
                double number) { return static_cast<std::int64_t>(static_cast<float>(number) * 20.0F); },
};
const ScaleRule kEvenSteps{
    .name = "even-steps",
    .says = kEvenSays,
    .number = even_number,
    .count = even_count,
    .beyond = Beyond::kClamped,
};
const ScaleRule kEvenStepsAround{
    .name = "even-steps-around",
    .says = kEvenSays,
    .number = even_number,
    .count = even_count,
    .beyond = Beyond::kWrapped,
};

const ScaleRule kTruncated{
    .name = "truncated",
    .says = kTruncatedSays,
    .number = truncated_number,
    .count = truncated_count,
    .beyond = Beyond::kClamped,
};
const ScaleRule kTruncatedOrNone{
    .name = "truncated-or-none",
    .says = kTruncatedSays,
    .number = truncated_number,
    .count = truncated_count,
    .beyond = Beyond::kClamped,
    .none_at_lowest = true,
};
const ScaleRule kTruncatedAroundOrNone{
    .name = "truncated-around-or-none",
    .says = kTruncatedSays,
    .number = truncated_number,
    .count = truncated_count,
    .beyond = Beyond::kWrapped,
    .none_at_lowest = true,
};
const ScaleRule kHundredths{
    .name = "hundredths",
    .says = "count = trunc(100 x) in float32",
    .number = [](const Field&, std::int64_t count) -> double { return static_cast<float>(count) / 100.0F; },
    .count = [](const Field&,
                double number) { return static_cast<std::int64_t>(static_cast<float>(number) * 100.0F); },
    .beyond = Beyond::kClamped,
};
const ScaleRule kThousandths{
    .name = "thousandths",
    .says = "count = trunc(1000 x) in float32",
    .number = [](const Field&, std::int64_t count) -> double { return static_cast<float>(count) / 1000.0F; },
    .count = [](const Field&,
                double number) { return static_cast<std::int64_t>(static_cast<float>(number) * 1000.0F); },
    .beyond = Beyond::kClamped,
};

std::span<const ScaleRule* const> scale_rules() {
  static constexpr const ScaleRule* kRules[] = {
      &kNearest,    &kWhole,           &kThirds,    &kAroundHalf,      &kTwentieths,
      &kEvenSteps,  &kEvenStepsAround, &kTruncated, &kTruncatedOrNone, &kTruncatedAroundOrNone,
      &kHundredths, &kThousandths};
  return kRules;
}

const ScaleRule* find_scale_rule(std::string_view name) {
  for (const ScaleRule* rule : scale_rules()) {
    if (rule->name == name) return rule;
  }
  return nullptr;
}

}  // namespace omnihil
