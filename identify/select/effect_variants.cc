#include "identify/select/effect_variants.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "sim/law/effect_registry.h"
#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

constexpr double kQuarterTurn_rad = std::numbers::pi / 2.0;

// The phase that belongs to a strength: the next such row before another strength.
int phase_of(const EffectInfo& info, std::size_t strength) {
  for (std::size_t i = strength + 1; i < info.params.size() && info.params[i].role == ParamRole::kShape;
       ++i) {
    if (info.params[i].trait == ParamTrait::kPeriodic) return static_cast<int>(i);
  }
  return -1;
}

void add_columns(const EffectInfo& info, std::size_t row_index, const Candidate& candidate,
                 EffectVariant& variant) {
  const EffectParam& row = info.params[row_index];
  VariantColumn column;
  column.row = static_cast<int>(row_index);
  column.size = visible_size(row, candidate);
  column.two_sided = row.lower < row.neutral && row.neutral < row.upper;
  if (column.size == 0.0) return;
  column.phase_row = phase_of(info, row_index);
  if (column.phase_row >= 0) column.two_sided = true;
  variant.columns.push_back(column);
  if (column.phase_row >= 0) {
    column.phase = kQuarterTurn_rad;
    variant.columns.push_back(column);
  }
}

std::vector<double> orders_of_motor(const DriveParams<double>& drive) {
  if (drive.pole_pairs <= 0) return {};
  std::vector<double> orders;
  const int poles = 2 * drive.pole_pairs;
  const double electrical = 6.0 * drive.pole_pairs;
  if (drive.slots > 0) {
    const int cogging = std::lcm(poles, drive.slots);
    for (const double n : {1.0 * cogging, 1.0 * drive.slots, 1.0 * poles}) orders.push_back(n);
  }
  orders.push_back(electrical);
  return orders;
}

std::vector<double> order_grid(const EffectParam& row, double start, const Candidate& candidate,
                               const DataScale& scale) {
  // Orders tried, and how many of the residual's: by cost, a simulation each. Tuned on the open cases;
  // sensitivity not measured.
  constexpr std::size_t kMost = 6, kOfResidual = 3;  // tuned
  std::vector<double> grid{start};
  const auto add = [&](double order) {
    // Below 1.5: once per turn, which has effects of its own (imbalance, eccentricity).
    if (order > 1.5 && order <= row.upper && grid.size() < kMost &&
        std::find(grid.begin(), grid.end(), order) == grid.end()) {
      grid.push_back(order);
    }
  };
  for (std::size_t i = 0; i < scale.orders.size() && i < kOfResidual; ++i) add(scale.orders[i]);
  if (scale.orders.empty()) {
    for (const double order : orders_of_motor(drive_of(candidate))) add(order);
  }
  return grid;
}

// What the values of a grid are multiples of; 0: the data do not say.
double grid_unit(GridOf of, double start, const DataScale& scale) {
  switch (of) {
    case GridOf::kStart:
      return start;
    case GridOf::kStartInTime:
      return scale.duration_s > 0.0 ? start : 0.0;
    case GridOf::kTopSpeed:
      return scale.top_speed_rad_s;
    case GridOf::kTopCurrent:
      return scale.top_current_A;
    case GridOf::kAbsolute:
      return 1.0;
  }
  return 0.0;
}

// Values that a shape is tried at.
std::vector<double> shape_grid(const EffectParam& row, double start, const Candidate& candidate,
                               const DataScale& scale) {
  if (row.trait == ParamTrait::kOrder) return order_grid(row, start, candidate, scale);
  const double unit = grid_unit(row.grid.of, start, scale);
  std::vector<double> grid;
  for (const double at : row.grid.at) {
    if (at != 0.0 && unit != 0.0) grid.push_back(std::clamp(at * unit, row.lower, row.upper));
  }
  return grid.empty() ? std::vector<double>{std::clamp(start, row.lower, row.upper)} : grid;
}

// The row of the order that an effect's series belongs to.
std::size_t order_row_of(const EffectInfo& info) {
  std::size_t row = 0;
  while (row + 1 < info.params.size() && info.params[row].series.count == 0) ++row;
  return row;
}

std::vector<std::size_t> rows_of_role(const EffectUse& use, ParamRole role) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < use.values.size(); ++i) {
    if (use.entry->info->params[i].role == role) rows.push_back(i);
  }
  return rows;
}

// A strength's further sizes, where no line leads from one size to another.
void add_sizes(const EffectInfo& info, std::vector<EffectVariant>& variants) {
  const std::size_t count = variants.size();
  for (const double size : info.params[first_strength(info)].grid.at) {
    if (size == 0.0 || size == 1.0) continue;
    for (std::size_t i = 0; i < count; ++i) variants.push_back(with_size(variants[i], size));
  }
}

// A shape that belongs to a detail has no influence while that is neutral.
bool belongs_to_detail(const EffectInfo& info, std::size_t row) {
  while (row > 0 && info.params[row].role == ParamRole::kShape) --row;
  return info.params[row].role == ParamRole::kDetail;
}

}  // namespace

EffectVariant with_size(EffectVariant variant, double factor) {
  for (VariantColumn& c : variant.columns) c.size *= factor;
  for (std::size_t row = 0; row < variant.shape.values.size(); ++row)
    variant.shape.values[row] *= std::pow(factor, variant.shape.entry->info->params[row].power_of_size);
  return variant;
}

double visible_size(const EffectParam& row, const Candidate& candidate) {
  if (row.start_for == nullptr) return (row.typical - row.neutral) * param_range(row, candidate).scale;
  const DriveParams<double> drive = drive_of(candidate);
  return start_of(row, &drive) - row.neutral;
}

std::vector<EffectVariant> variants_of(const EffectEntry& entry, const Candidate& candidate,
                                       const DataScale& scale) {
  const EffectInfo& info = *entry.info;
  const EffectUse neutral = neutral_use(entry, candidate);
  std::vector<EffectVariant> variants{{.shape = neutral, .columns = {}}};
  for (const std::size_t i : rows_of_role(neutral, ParamRole::kShape)) {
    if (belongs_to_detail(info, i)) continue;
    const std::vector<double> grid =
        shape_grid(info.params[i], variants.front().shape.values[i], candidate, scale);
    std::vector<EffectVariant> more;
    for (const EffectVariant& v : variants) {
      for (const double value : grid) {
        more.push_back(v);
        more.back().shape.values[i] = value;
      }
    }
    variants = std::move(more);
  }
  for (EffectVariant& v : variants) {
    for (const std::size_t row : rows_of_role(neutral, ParamRole::kStrength)) {
      add_columns(info, row, candidate, v);
    }
  }
  add_sizes(info, variants);
  return variants;
}

std::vector<EffectVariant> extensions_of(const EffectUse& use, const Candidate& candidate,
                                         const DataScale& scale) {
  std::vector<EffectVariant> variants;
  const EffectInfo& info = *use.entry->info;
  const HarmonicSeries series = series_of(info);
  for (const std::size_t row : rows_of_role(use, ParamRole::kDetail)) {
    if (use.values[row] != info.params[row].neutral) continue;
    if (const int k = harmonic_of(series, row); k > 0) {
      // the first two, and those whose order shows in the residual
      const double order = use.values[order_row_of(info)] * k;
      const bool shows = std::any_of(scale.orders.begin(), scale.orders.end(),
                                     [&](double n) { return std::abs(n - order) < 0.5; });
      if (!shows && k > 3) continue;
    }
    EffectVariant v{.shape = use, .columns = {}};
    add_columns(info, row, candidate, v);
    variants.push_back(std::move(v));
  }
  return variants;
}

std::vector<EffectVariant> series_variants(const EffectEntry& entry, const Candidate& candidate,
                                           const DataScale& scale) {
  constexpr int kMostOrders = 4;  // by cost, a fit of two parameters each; sensitivity not measured
  const HarmonicSeries series = series_of(*entry.info);
  if (series.count == 0) return {};
  std::vector<int> orders;
  for (const double n : scale.orders) {
    if (n > 1.5 && std::abs(n - std::round(n)) < 1e-6 && static_cast<int>(orders.size()) < kMostOrders) {
      orders.push_back(static_cast<int>(std::lround(n)));
    }
  }
  std::vector<EffectVariant> variants;
  for (std::size_t count = 2; count <= orders.size(); ++count) {
    int common = 0;
    for (std::size_t i = 0; i < count; ++i) common = std::gcd(common, orders[i]);
    const int highest =
        *std::max_element(orders.begin(), orders.begin() + static_cast<std::ptrdiff_t>(count));
    if (highest > (series.count + 1) * common) continue;
    EffectVariant v{.shape = neutral_use(entry, candidate), .columns = {}};
    v.shape.values[order_row_of(*entry.info)] = common;
    for (std::size_t i = 0; i < count; ++i) {
      const int k = orders[i] / common;
      const std::size_t row = k == 1 ? first_strength(*entry.info) : harmonic_row(series, k);
      add_columns(*entry.info, row, candidate, v);
    }
    variants.push_back(std::move(v));
  }
  return variants;
}

EffectUse setting(const EffectVariant& variant, const VariantColumn& column) {
  EffectUse use = variant.shape;
  use.values[static_cast<std::size_t>(column.row)] += column.size;
  if (column.phase_row >= 0) use.values[static_cast<std::size_t>(column.phase_row)] = column.phase;
  return use;
}

EffectUse start_of(const EffectVariant& variant, const std::vector<double>& coefficients,
                   const Candidate& model) {
  EffectUse use = variant.shape;
  const EffectInfo& info = *use.entry->info;
  for (std::size_t c = 0; c < variant.columns.size(); ++c) {
    const VariantColumn& column = variant.columns[c];
    double& value = use.values[static_cast<std::size_t>(column.row)];
    const ParamRange range = param_range(info.params[static_cast<std::size_t>(column.row)], model);
    if (column.phase_row >= 0) {
      if (column.phase != 0.0) continue;  // taken with its sine
      const double sine = coefficients[c], cosine = coefficients[c + 1];
      value += column.size * std::hypot(sine, cosine);
      use.values[static_cast<std::size_t>(column.phase_row)] = std::atan2(cosine, sine);
    } else {
      value += column.size * coefficients[c];
    }
    value = std::clamp(value, range.lower, range.upper);
  }
  return use;
}

Candidate with_use(const Candidate& candidate, const EffectUse& use) {
  Candidate out = candidate;
  const std::string name = effect_name(use);
  std::erase_if(out.effects, [&](const EffectUse& u) { return effect_name(u) == name; });
  const auto place =
      std::upper_bound(out.effects.begin(), out.effects.end(), name,
                       [](const std::string& n, const EffectUse& u) { return n < effect_name(u); });
  out.effects.insert(place, use);
  return with_values(out, {}, {});  // updates the effects in its file
}

}  // namespace omnihil
