#include "identify/select/screening.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "identify/record/parallel.h"
#include "identify/record/statistics.h"
#include "identify/select/strength_grid.h"
#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

struct Scored {
  EffectVariant variant;
  std::vector<bool> two_sided;
  ProjectedColumns columns;
  LinearGain fit;
  bool from_priors = false;  // the base parameters at their priors, not where the fit's linear estimates are
  bool finite = false;
};

std::vector<bool> sides(const EffectVariant& variant) {
  std::vector<bool> two_sided;
  for (const VariantColumn& c : variant.columns) two_sided.push_back(c.two_sided);
  return two_sided;
}

Scored score(const ScreeningTask& task, EffectVariant variant) {
  Scored out{.variant = std::move(variant), .two_sided = {}, .columns = {}, .fit = {}};
  out.two_sided = sides(out.variant);
  Eigen::MatrixXd columns(task.residuals->size(), static_cast<Eigen::Index>(out.variant.columns.size()));
  for (std::size_t c = 0; c < out.variant.columns.size(); ++c) {
    const Eigen::VectorXd with =
        task.residuals->predicted(with_use(*task.model, setting(out.variant, out.variant.columns[c])));
    if (with.size() != task.residuals->size()) return out;
    columns.col(static_cast<Eigen::Index>(c)) =
        (with - task.base->prediction()).cwiseProduct(task.base->weights());
  }
  out.columns = task.base->project(std::move(columns));
  out.fit = task.base->gain(out.columns, out.two_sided);
  out.finite = true;
  return out;
}

// Sizes at which the linear coefficients would be one; false: they are nearly so, or cannot be changed.
bool resize(const ScreeningTask& task, const Scored& scored, EffectVariant& variant, double idle_factor) {
  // Largest size tried, of the parameter's bound; smallest, of that; a change of size below this factor is
  // none. Choices; all three only save simulations: the refit starts from the coefficients, whatever the size was.
  constexpr double kOfBound = 0.9, kLeastOfBound = 1e-6, kSameBelow = 0.7, kSameAbove = 1.4;  // choices
  bool changed = false;
  const EffectInfo& info = *variant.shape.entry->info;
  for (std::size_t c = 0; c < variant.columns.size(); ++c) {
    VariantColumn& column = variant.columns[c];
    const EffectParam& row = info.params[static_cast<std::size_t>(column.row)];
    const ParamRange range = param_range(row, *task.model);
    double factor = std::abs(scored.fit.coefficients[c]);
    if (column.phase_row >= 0) {
      const std::size_t other = column.phase == 0.0 ? c + 1 : c - 1;
      factor = std::hypot(factor, scored.fit.coefficients[other]);
    }
    if (scored.fit.gain <= 0.0) factor = idle_factor;
    if (factor <= 0.0) continue;
    const double most =
        kOfBound * (column.size > 0.0 ? range.upper - row.neutral : row.neutral - range.lower);
    const double size = std::clamp(std::abs(column.size) * factor, kLeastOfBound * most, most);
    const double ratio = size / std::abs(column.size);
    if (ratio > kSameBelow && ratio < kSameAbove) continue;
    column.size = std::copysign(size, column.size);
    changed = true;
  }
  return changed;
}

// The shape of largest gain, then at the size that its coefficient estimates. `typical`: score of the first one.
Scored best_of(const ScreeningTask& task, const std::vector<EffectVariant>& variants, const Scored& typical) {
  constexpr int kResizings = 3;  // by cost: a simulation each
  // Where no size gained: one well below and, after it, one well above. Tuned on the open cases; sensitivity
  // not measured.
  constexpr double kSmaller = 0.3, kLarger = 8.0;  // tuned
  Scored best;
  for (const EffectVariant& v : variants) {
    if (v.columns.empty()) continue;
    Scored s = &v == &variants.front() ? typical : score(task, v);
    if (s.finite && (!best.finite || s.fit.gain > best.fit.gain)) best = std::move(s);
  }
  if (!best.finite) return best;
  EffectVariant next = best.variant;
  Scored latest = best;
  for (int k = 0; k < kResizings; ++k) {
    // A limit may lie above what the data reach, a delay be too long for the linear range: try both.
    if (!resize(task, latest, next, k == 0 ? kSmaller : kLarger)) break;
    latest = score(task, next);
    if (!latest.finite) break;
    if (latest.fit.gain > best.fit.gain) best = latest;
  }
  return best;
}

// For a law that acts from some strength on only (a limit that the data reach): sizes one by one, each as it
// is. It has no derivative below that strength, and extrapolating from one above leads back to where it is
// idle (DECISIONS 33).
class SizeSearch {
 public:
  // `typical`: score of the first variant.
  SizeSearch(const ScreeningTask& task, const Scored& typical) : task_(task), typical_(typical) {}

  Scored run(const std::vector<EffectVariant>& variants) {
    first_ = &variants.front();
    // Octaves about the typical size: 8 times to a 128th of it. Halvings of the last octave: to 2 % of the
    // size where it begins to act (2^(1/32)). Choices, by cost: a simulation each.
    constexpr int kLargest = 3, kSmallest = -7, kHalvings = 5;  // by cost
    // Sizes beyond that one. Tuned on the open cases (DECISIONS 33); sensitivity not measured.
    constexpr double kBeyond[] = {1.08, 1.2, 1.4, 1.7};  // tuned
    for (const EffectVariant& v : variants) {
      double acts = 0.0, idle = 0.0;  // factors of its typical size
      for (int k = kLargest; k >= kSmallest && idle == 0.0; --k) {
        (attempt(v, std::exp2(k)) ? acts : idle) = std::exp2(k);
      }
      if (acts == 0.0 || idle == 0.0) continue;
      for (int n = 0; n < kHalvings; ++n) {
        const double middle = std::sqrt(acts * idle);
        (attempt(v, middle) ? acts : idle) = middle;
      }
      for (const double beyond : kBeyond) attempt(v, acts * beyond);
    }
    for (const double refining : {std::exp2(0.25), std::exp2(-0.25)}) {
      if (best_.finite) attempt(EffectVariant(best_.variant), refining);
    }
    return std::move(best_);
  }

 private:
  // Does it change any signal at this multiple of its size?
  bool attempt(const EffectVariant& variant, double factor) {
    EffectVariant sized = variant;
    VariantColumn& column = sized.columns.front();
    const EffectParam& row = variant.shape.entry->info->params[static_cast<std::size_t>(column.row)];
    const ParamRange range = param_range(row, *task_.model);
    column.size *= factor;
    if (column.size <= 0.0 || row.neutral + column.size > range.upper) return true;
    Scored s = &variant == first_ && factor == 1.0 ? typical_ : score(task_, std::move(sized));
    if (!s.finite) return true;
    s.fit = task_.base->gain_as_tried(s.columns);
    constexpr double kActs =
        1e-6;  // of the residual's energy: above rounding, below anything that gains; a choice
    const bool acts = s.columns.gram(0, 0) > kActs * task_.base->energy();
    if (!best_.finite || s.fit.gain > best_.fit.gain) best_ = std::move(s);
    return acts;
  }

  const ScreeningTask& task_;
  const Scored& typical_;
  const EffectVariant* first_ = nullptr;
  Scored best_;
};

// The model with the base parameters at their priors and the effect at one of its sizes, as it is: where no line leads from one
// size to another, the base parameters have been fitted to what the effect does, and nothing linear about them leads back.
// Not finite: the effect's sizes have no grid, or none leaves less than the parent.
Scored best_from_priors(const ScreeningTask& task, const EffectEntry& entry) {
  Scored best;
  // A play's simulations are dear, at the shortest step throughout, and its fit begins from half and twice the size anyway.
  if (task.at_priors == nullptr || (entry.info->numerics & kImpacts) != 0) return best;
  const EffectVariant typical = variants_of(entry, *task.at_priors, task.scale).front();
  if (typical.columns.size() != 1) return best;
  const LinearBase& base = *task.base;
  for (const double size : sizes_across_grid(entry.info->params[first_strength(*entry.info)])) {
    EffectVariant variant = with_size(typical, size);
    const Eigen::VectorXd with =
        task.residuals->predicted(with_use(*task.at_priors, setting(variant, variant.columns.front())));
    if (with.size() != task.residuals->size()) continue;
    Eigen::MatrixXd change = (with - base.prediction()).cwiseProduct(base.weights());
    const double gain = base.energy() - (base.residual() - change.col(0)).squaredNorm();
    if (!(gain > best.fit.gain)) continue;
    best.two_sided = sides(variant);
    best.columns = base.project(std::move(change));
    best.fit = {.gain = gain, .data_gain = gain, .coefficients = {1.0}, .base_shift = {}};
    best.variant = std::move(variant);
    best.from_priors = best.finite = true;
  }
  return best;
}

double share_in(const RegimeMask& regime, const ProjectedColumns& p, const std::vector<bool>& two_sided,
                const Eigen::VectorXd& residual, const std::vector<Eigen::VectorXd>& noise) {
  const Eigen::MatrixXd inside = regime.inside.asDiagonal() * p.columns;
  const double energy = residual.cwiseProduct(regime.inside).squaredNorm();
  if (energy <= 0.0) return 0.0;
  const Eigen::MatrixXd gram = inside.transpose() * inside;
  const double gain = bounded_gain(gram, inside.transpose() * residual, two_sided).first;
  double chance = 0.0;
  for (const Eigen::VectorXd& n : noise) {
    chance = std::max(chance, bounded_gain(gram, inside.transpose() * n, two_sided).first);
  }
  return std::max(0.0, gain - chance) / energy;
}

// The base parameter with the largest part in the regression of the effect's signal on all of them.
std::string nearest_base(const LinearBase& base, const Scored& s) {
  std::string nearest;
  double best = 0.0;
  for (Eigen::Index u = 0; u < s.columns.coupling.rows(); ++u) {
    const double size = base.derivatives().col(u).norm() * s.columns.coupling.row(u).norm();
    if (size > best) {
      best = size;
      nearest = base.unknowns()[static_cast<std::size_t>(u)].path;
    }
  }
  return nearest;
}

Screened finished(const ScreeningTask& task, const EffectEntry* entry, Scored best) {
  Screened out;
  out.entry = entry;
  if (!best.finite) return out;
  const LinearBase& base = *task.base;
  out.tried = true;
  out.gain = best.fit.gain;
  for (const Eigen::VectorXd& n : task.noise) {
    out.null_gain = std::max(out.null_gain, base.gain_in_noise(best.columns, best.two_sided, n));
  }
  out.share = std::max(0.0, out.gain - out.null_gain) / std::max(base.energy(), 1e-300);
  const double in_data = best.fit.data_gain / std::max(base.energy(), 1e-300);
  out.prior_share = out.share - std::clamp(in_data, 0.0, out.share);
  for (const RegimeMask& regime : task.regimes) {
    const double share = share_in(regime, best.columns, best.two_sided, base.residual(), task.noise);
    if (share > out.best_regime_share) {
      out.best_regime_share = share;
      out.best_regime = regime.name;
    }
  }
  out.residual_fraction = best.columns.kept;
  out.closest_parameter = nearest_base(base, best);
  out.start = start_of(best.variant, best.fit.coefficients, *task.model);
  out.base_unknowns = best.from_priors ? unknowns_of(*task.at_priors) : base.unknowns();
  for (std::size_t u = 0; u < out.base_unknowns.size(); ++u) {
    const Unknown& unknown = out.base_unknowns[u];
    const double shift = best.from_priors ? 0.0 : best.fit.base_shift[static_cast<Eigen::Index>(u)];
    out.base_start.push_back(std::clamp(unknown.start + shift, unknown.lower, unknown.upper));
  }
  const Eigen::Map<const Eigen::VectorXd> a(best.fit.coefficients.data(),
                                            static_cast<Eigen::Index>(best.fit.coefficients.size()));
  out.signal = best.columns.columns * a;
  const Eigen::VectorXd scale = base.weights().unaryExpr([](double w) { return w > 0.0 ? 1.0 / w : 0.0; });
  out.columns = scale.asDiagonal() * best.columns.columns;
  out.two_sided = std::move(best.two_sided);
  out.unresolved = unresolved_share(out.start, task.drift, out.signal);
  return out;
}

Screened screen_one(const ScreeningTask& task, const EffectEntry* entry) {
  if (is_never_resolved(*entry->info, task.drift)) {
    Screened lost;
    lost.entry = entry;
    lost.name = std::string(entry->info->id);
    lost.unresolved = 1.0;
    return lost;
  }
  std::vector<EffectVariant> variants = variants_of(*entry, *task.model, task.scale);
  const bool steps_in = (entry->info->claims & kFlatAtNeutral) != 0 && variants.front().columns.size() == 1;
  // At its typical size, whatever the data estimate: for visibility.
  const Scored typical = score(task, variants.front());
  Scored best = steps_in ? SizeSearch(task, typical).run(variants) : best_of(task, variants, typical);
  if (best.finite) {
    for (const EffectVariant& v : series_variants(*entry, *task.model, task.scale)) {
      Scored series = score(task, v);
      // Several orders have to gain this factor more than one. Tuned on the open cases; sensitivity not
      // measured.
      constexpr double kSeriesGain = 1.05;  // tuned
      if (series.finite && series.fit.gain > kSeriesGain * best.fit.gain) best = std::move(series);
    }
  }
  if (Scored whole = best_from_priors(task, *entry);
      whole.finite && (!best.finite || whole.fit.gain > best.fit.gain))
    best = std::move(whole);
  Screened out = finished(task, entry, std::move(best));
  out.name = std::string(entry->info->id);
  if (typical.finite) out.typical_gain = typical.columns.gram.trace();
  return out;
}

double quantile_of(std::vector<double> values, double share) {
  return quantile(std::move(values), share, QuantileRank::kAbove);
}

std::vector<double> finite_sizes(const Eigen::VectorXd& track) {
  std::vector<double> sizes;
  for (const double v : track) {
    if (std::isfinite(v)) sizes.push_back(std::abs(v));
  }
  return sizes;
}

}  // namespace

std::string Screened::aliased_parameter() const {
  if (!tried || residual_fraction >= kAliasedFraction || closest_parameter.empty()) return "";
  const auto& listed = entry->info->twins;
  return std::find(listed.begin(), listed.end(), closest_parameter) != listed.end() ? closest_parameter : "";
}

std::vector<RegimeMask> regime_masks(const WhitenedResiduals& residuals, const Candidate& model) {
  std::vector<RegimeMask> masks;
  const Eigen::VectorXd speed = residuals.track(model, "speed");
  const Eigen::VectorXd acceleration = residuals.track(model, "acceleration");
  const std::vector<double> speeds = finite_sizes(speed), accelerations = finite_sizes(acceleration);
  // Samples in a regime: its mean square is then known to 10 % (sqrt(2 / n)); a choice.
  constexpr std::size_t kLeast = 200;  // a choice
  // Limits of the regimes: shares of the top speed (98 % quantile, so that no glitch sets it), quantiles of
  // the acceleration. Tuned on the open cases; sensitivity not measured.
  constexpr double kTopQuantile = 0.98, kSlow = 0.1, kFast = 0.6;     // tuned
  constexpr double kSteadyQuantile = 0.5, kTransientQuantile = 0.85;  // tuned
  const auto add = [&](const char* name, auto&& is_inside) {
    RegimeMask mask{.name = name, .inside = Eigen::VectorXd::Zero(residuals.size())};
    for (Eigen::Index i = 0; i < residuals.size(); ++i) mask.inside[i] = is_inside(i) ? 1.0 : 0.0;
    if (mask.inside.sum() >= static_cast<double>(kLeast)) masks.push_back(std::move(mask));
  };
  if (speeds.size() >= kLeast) {
    const double top = quantile_of(speeds, kTopQuantile);
    add("slow", [&](Eigen::Index i) { return std::abs(speed[i]) < kSlow * top; });
    add("fast", [&](Eigen::Index i) { return std::abs(speed[i]) > kFast * top; });
  }
  if (accelerations.size() >= kLeast) {
    const double quasi_static = quantile_of(accelerations, kSteadyQuantile);
    const double dynamic = quantile_of(accelerations, kTransientQuantile);
    add("steady", [&](Eigen::Index i) { return std::abs(acceleration[i]) < quasi_static; });
    add("transient", [&](Eigen::Index i) { return std::abs(acceleration[i]) > dynamic; });
  }
  return masks;
}

std::vector<Screened> screen(const ScreeningTask& task, const std::vector<const EffectEntry*>& effects) {
  std::vector<Screened> out(effects.size());
  std::atomic<int> done{0};
  std::atomic<bool> stopped{false};
  parallel_for(task.jobs, static_cast<int>(effects.size()), [&](int k) {
    const std::size_t e = static_cast<std::size_t>(k);
    out[e].entry = effects[e];
    out[e].name = std::string(effects[e]->info->id);
    if (stopped) return;
    out[e] = screen_one(task, effects[e]);
    const double share = ++done / static_cast<double>(effects.size());
    if (task.progress && !task.progress(share)) stopped = true;
  });
  return out;
}

std::vector<Screened> screen_extensions(const ScreeningTask& task) {
  std::vector<Screened> out;
  for (const EffectUse& use : task.model->effects) {
    const std::vector<EffectVariant> variants = extensions_of(use, *task.model, task.scale);
    if (variants.empty()) continue;
    Screened s = finished(task, use.entry, best_of(task, variants, score(task, variants.front())));
    s.name = effect_name(use);
    s.extends = true;
    out.push_back(std::move(s));
  }
  return out;
}

}  // namespace omnihil
