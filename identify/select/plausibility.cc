#include "identify/select/plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/law/effect_registry.h"
#include "sim/law/param_range.h"
#include "sim/law/symmetric.h"
#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

// Wald's test at 5 %: the normal quantile 1.96, rounded.
constexpr double kSignificant_sigmas = 2.0;  // derived
// Prior deviation from which a base parameter counts as out of its tolerance (two-sided p = 5e-4), and how
// much farther than without the effect it has to be. Tuned on the open cases (DECISIONS 22); sensitivity not
// measured.
constexpr double kOutOfTolerance_sigmas = 3.5;  // tuned
constexpr double kDeviationRise_sigmas = 0.7;   // tuned

// Standard deviation of an angle of which nothing is known, 2 pi / sqrt(12).
constexpr double kUniformAngle_rad = 1.8138;  // derived

// Null: the fit has no such parameter.
const ParameterEstimate* estimate_of(const FitResult& fit, std::string_view path) {
  const auto at = std::ranges::find(fit.parameters, path, &ParameterEstimate::path);
  return at == fit.parameters.end() ? nullptr : &*at;
}

// In sigmas, signed; by its value where it is not reported: numbers that only their sum determines are no less far from what is
// known of them.
double deviation_of(const ParameterEstimate& p) {
  return p.prior_deviation_sigmas != 0.0 ? p.prior_deviation_sigmas : prior_z(p, p.value);
}

}  // namespace

// What its prior rejects without
// any addition absorbs something that is missing (an inductance a delay): beside a decisive gain it says nothing against this
// one. What an earlier addition moved that far is no such number: two laws would walk twice as far as one may. An earlier
// effect's own numbers, which no base fit has, are believed to be of a usual size and no more: the parent's deviation counts.
std::vector<MovedNumber> moved_numbers(const FitResult& parent, const FitResult& child, bool decisive,
                                       const FitResult* base) {
  std::vector<MovedNumber> out;
  for (const ParameterEstimate& p : child.parameters) {
    const double sigmas = std::abs(deviation_of(p));
    if (p.prior_sigma <= 0.0 || (sigmas < kOutOfTolerance_sigmas && !p.at_bound)) continue;
    const ParameterEstimate *before = estimate_of(parent, p.path),
                            *at_first = estimate_of(base != nullptr ? *base : parent, p.path);
    if (before == nullptr) continue;  // of the effect itself
    const double was = std::abs(deviation_of(*before)),
                 was_at_first = at_first == nullptr ? was : std::abs(deviation_of(*at_first));
    if (decisive && std::min(was, was_at_first) >= kPriorRejected_sigmas) continue;
    // A bound at zero lies nearer than the limit where the tolerance is wide: the addition stands in for the parameter.
    const bool replaced = p.at_bound && !before->at_bound && sigmas >= kRestored_sigmas;
    if (sigmas - was > kDeviationRise_sigmas && (replaced || sigmas >= kOutOfTolerance_sigmas)) {
      out.push_back({p.path, fmt::format("it moves {} {} ({:+.1f} sigma, before {:+.1f})", p.path,
                                         replaced ? "to its bound" : "out of its tolerance", deviation_of(p),
                                         deviation_of(*before))});
    }
  }
  return out;
}

namespace {

// A shape estimated at its bound suggests that the law is fitting something else. A strength may stay at its
// neutral value (one of several; 1e-3 of its typical size is the optimiser's resolution there), a phase is
// periodic, an exponent is a choice of form, a smoothing width goes to the sharp law at its lower bound.
bool suspicious_bound(const ParameterEstimate& p, const EffectParam* row, const Candidate& model) {
  if (!p.at_bound || row == nullptr) return false;
  if (row->role != ParamRole::kShape) return std::abs(p.value - row->neutral) > 1e-3 * std::abs(row->typical);
  if (row->trait == ParamTrait::kSmoothing) {
    const ParamRange range = param_range(*row, model);
    return p.value > 0.5 * (range.lower + range.upper);
  }
  return row->trait != ParamTrait::kPeriodic && row->trait != ParamTrait::kForm;
}

// Joint significance of several strengths: those that are correlated (four ratios that share their scale with
// a base parameter) may each be uncertain where their differences are not. Wald's statistic d' C^-1 d against
// the 95 % quantile of chi-square with n degrees of freedom.
bool jointly_significant(const FitResult& child, const std::vector<Eigen::Index>& rows,
                         const std::vector<double>& away) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  if (n < 2 || rows.back() >= child.covariance.rows()) return false;
  const Eigen::VectorXd d = Eigen::Map<const Eigen::VectorXd>(away.data(), n);
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      covariance(i, j) =
          child.covariance(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(j)]);
    }
  }
  // Growth of that quantile per degree of freedom: 3.84, 5.99, 7.81, 9.49 for n = 1 to 4, the line below
  // within 5 %.
  constexpr double kPerFurther = 1.9;  // derived
  const double asked = kSignificant_sigmas * kSignificant_sigmas + kPerFurther * static_cast<double>(n - 1);
  return d.dot(ldlt_solve(covariance, d)) > asked;
}

// The catalogue's row of an effect's parameter; null: none.
const EffectParam* row_of(const EffectEntry* entry, const FitResult& fit, std::string_view key) {
  if (entry == nullptr) return nullptr;
  for (const EffectParam& row : entry->info->params) {
    if (row.name == key || param_key(row, fit.model.file.linear) == key) return &row;
  }
  return nullptr;
}

// An effect over an angle of which the data determine no phase (a harmonic without strength has none of its own).
std::string not_locked_to_angle(const FitResult& child, const std::string& name) {
  const EffectEntry* entry = find_effect(name);
  const ParameterEstimate* vague = nullptr;
  for (const ParameterEstimate& p : child.parameters) {
    if (!p.path.starts_with(name + ".")) continue;
    const EffectParam* row = row_of(entry, child, p.path.substr(name.size() + 1));
    if (row == nullptr || row->trait != ParamTrait::kPeriodic) continue;
    if (p.sigma <= kUniformAngle_rad) return "";
    if (vague == nullptr) vague = &p;
  }
  if (vague == nullptr) return "";
  return fmt::format("{} is not determined (+- {:.2g} rad): what it takes is not locked to the angle",
                     vague->path, vague->sigma);
}

// A spring and its damper in one law, damped so far beyond the critical c = 2 sqrt(k J) that it creeps to its place: a lag, which
// is another law's. Bristles are near it: half of it where they were published (Canudas de Wit, Olsson, Astrom, Lischinsky
// 1995: 316 N s/m on 1e5 N/m and 1 kg). Empty: no.
std::string overdamped(const FitResult& child, const std::string& name) {
  constexpr double kMostDamping = 5.0;  // times the critical; a choice
  const auto estimate = [&](std::string_view of) {
    const auto at = std::ranges::find_if(child.parameters, [&](const ParameterEstimate& p) {
      return p.path.starts_with(name + "." + std::string(of));
    });
    return at == child.parameters.end() ? 0.0 : at->value;
  };
  const double stiffness = estimate("stiffness_"), damping = estimate("damping_"),
               inertia = inertia_at_rotor(drive_of(child.model));
  if (!(stiffness > 0.0 && inertia > 0.0)) return "";
  const double ratio = damping / (2.0 * std::sqrt(stiffness * inertia));
  if (ratio < kMostDamping) return "";
  return fmt::format(
      "it is damped {:.2g} times as much as it takes not to swing and settles in {:.2g} s: a lag, not a "
      "spring",
      ratio, damping / stiffness);
}

// A form whose plain value is zero and which does away from there what the strength does (a loop's period lags as its time
// constant does): the data may know the sum where they do not know the parts.
bool acts_as_strength(const EffectParam& row) {
  return row.role == ParamRole::kShape && row.trait == ParamTrait::kForm && row.typical == 0.0 &&
         row.lower == 0.0;
}

// A parameter of the effect that no drive can have, or a strength that is not significant; empty: none.
std::string implausible_estimate(const FitResult& child, const std::string& name, bool decisive) {
  const std::string at_bound = ends_at_bound(child, name);
  if (!at_bound.empty()) return at_bound;
  std::string loose = not_locked_to_angle(child, name);
  if (loose.empty()) loose = overdamped(child, name);
  if (!loose.empty()) return loose;
  const EffectEntry* entry = find_effect(name);
  bool strong = entry == nullptr;
  std::vector<Eigen::Index> strengths;
  std::vector<double> away;
  for (std::size_t n = 0; n < child.parameters.size(); ++n) {
    const ParameterEstimate& p = child.parameters[n];
    if (!p.path.starts_with(name + ".")) continue;
    const EffectParam* row = row_of(entry, child, p.path.substr(name.size() + 1));
    if (row == nullptr) continue;
    if (acts_as_strength(*row)) {
      strengths.push_back(static_cast<Eigen::Index>(n));
      away.push_back(p.value);
    }
    if (row->role == ParamRole::kShape) continue;
    const double size = std::abs(p.value - row->neutral);
    if (p.unphysical && size > 1e-9)
      return fmt::format("{} = {:.4g} {} is not physical", p.path, p.value, p.unit);
    // Uses the posterior sigma (priors included): without a current channel the data fix only ratios of
    // parameters.
    if (size > kSignificant_sigmas * p.sigma || p.sigma <= 0.0) strong = strong || size > 0.0;
    strengths.push_back(static_cast<Eigen::Index>(n));
    away.push_back(p.value - row->neutral);
  }
  strong = strong || jointly_significant(child, strengths, away);
  return strong || decisive ? "" : "its strength is not significantly different from zero";
}

// Sum of the squared prior deviations of all parameters, the effects' own included.
double prior_chi_square(const FitResult& fit) {
  double sum = 0.0;
  for (const ParameterEstimate& p : fit.parameters) {
    sum += std::pow(prior_z(p, p.value), 2);
  }
  return sum;
}

}  // namespace

PriorDeviation largest_prior_deviation(const FitResult& fit) {
  PriorDeviation worst;
  for (const ParameterEstimate& p : fit.parameters) {
    if (p.prior_sigma <= 0.0 || !p.identifiable || find_effect(p.path.substr(0, p.path.find('.'))) != nullptr)
      continue;
    if (std::abs(p.prior_deviation_sigmas) > worst.sigmas)
      worst = {.sigmas = std::abs(p.prior_deviation_sigmas), .path = p.path};
  }
  return worst;
}

double prior_deviation(const FitResult& fit, std::string_view path) {
  const ParameterEstimate* p = estimate_of(fit, path);
  return p == nullptr ? 0.0 : std::abs(prior_z(*p, p->value));
}

bool is_implausible(const FitResult& fit) {
  return largest_prior_deviation(fit).sigmas >= kImplausible_sigmas;
}

bool is_prior_rejected(const FitResult& fit, std::string_view path) {
  return prior_deviation(fit, path) >= kPriorRejected_sigmas;
}

std::string restores_prior(const FitResult& parent, const FitResult& child,
                           std::string_view aliased_parameter) {
  const PriorDeviation before = largest_prior_deviation(parent), after = largest_prior_deviation(child);
  if (is_implausible(parent) && after.sigmas <= kRestored_sigmas &&
      prior_deviation(child, before.path) <= kRestored_sigmas) {
    return before.path;
  }
  const bool restored =
      is_prior_rejected(parent, aliased_parameter) &&
      prior_deviation(child, aliased_parameter) < prior_deviation(parent, aliased_parameter) &&
      prior_chi_square(parent) - prior_chi_square(child) >= kPriorRejected_sigmas * kPriorRejected_sigmas;
  return restored && after.sigmas <= std::max(before.sigmas, kRestored_sigmas)
             ? std::string(aliased_parameter)
             : "";
}

std::string below_resolution(const FitResult& child, const std::string& name, const Resolution& of) {
  // Of the visible size: below, a model's own sub-steps amount to as much. Tuned: every false alarm left was
  // 4 us of delay at 1 kHz (DECISIONS 55); sensitivity not measured. Of an angle, a twentieth of two counts.
  constexpr double kOfVisible = 0.05;  // tuned
  const EffectEntry* entry = find_effect(name);
  if (entry == nullptr || entry->info->min_visible == nullptr || of.rate_Hz <= 0.0) return "";
  const EffectParam& row = entry->info->params[first_strength(*entry->info)];
  const bool is_time = row.trait == ParamTrait::kTime,
             is_angle = row.unit == "rad" && of.counts_per_rotor_turn > 0.0;
  if (!is_time && !is_angle) return "";
  SensorSet sensors{.rate_Hz = of.rate_Hz};
  if (is_angle) sensors.counts_per_turn = of.counts_per_rotor_turn;
  const double visible = entry->info->min_visible(sensors);
  for (const ParameterEstimate& p : child.parameters) {
    if (p.path != name + "." + std::string(row.name)) continue;
    if (is_time && std::abs(p.value - row.neutral) < of.loop_period_s) {
      return fmt::format(
          "{} = {:.2g} {} is less than a period of the speed loop ({:.2g} s), whose description knows no "
          "instant within it",
          p.path, p.value, p.unit, of.loop_period_s);
    }
    if (std::abs(p.value - row.neutral) >= kOfVisible * visible) continue;
    return fmt::format(
        "{} = {:.2g} {} is below the {} resolution: at {:g} {} such an effect is visible from {:.2g} {}",
        p.path, p.value, p.unit, is_time ? "time" : "angle", is_time ? of.rate_Hz : of.counts_per_rotor_turn,
        is_time ? "Hz" : "counts a turn", visible, p.unit);
  }
  return "";
}

std::string ends_at_bound(const FitResult& child, const std::string& name) {
  const EffectEntry* entry = find_effect(name);
  for (const ParameterEstimate& p : child.parameters) {
    if (!p.path.starts_with(name + ".")) continue;
    const EffectParam* row = row_of(entry, child, p.path.substr(name.size() + 1));
    if (suspicious_bound(p, row, child.model))
      return fmt::format("{} ends at a bound ({:.4g} {}): a symptom, not a result", p.path, p.value, p.unit);
  }
  return "";
}

std::string implausibility(const FitResult& parent, const FitResult& child, const std::string& name,
                           bool decisive, const FitResult* base) {
  const std::string why = implausible_estimate(child, name, decisive);
  if (!why.empty()) return why;
  const std::vector<MovedNumber> moved = moved_numbers(parent, child, decisive, base);
  return moved.empty() ? "" : moved.front().why;
}

}  // namespace omnihil
