#include "identify/select/refit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "identify/select/plausibility.h"
#include "identify/select/strength_grid.h"
#include "sim/law/effect_registry.h"
#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

// Further starts, by cost: screened share of the residual energy from which they are worth a fit each. Tuned
// on the open cases; sensitivity not measured.
constexpr double kWorthTypicalStart = 0.2;  // tuned
constexpr double kWorthPriorStart = 0.1;    // tuned
// Noise's share of what a fit leaves above which no other valley of the strength is looked for: a choice, what
// remains would be a fifth of the energy.
constexpr double kNearNoise = 0.8;  // a choice
// A start has succeeded if it gains this fraction of what the screening predicts (it is linear, and not on
// all bounds).
constexpr double kOfPredicted = 0.5;  // a choice

// Sets the starts of the unknowns named by `paths`.
void start_at(std::vector<Unknown>& unknowns, const std::vector<Unknown>& paths,
              const std::vector<double>& values) {
  for (std::size_t i = 0; i < paths.size() && i < values.size(); ++i) {
    for (Unknown& u : unknowns) {
      if (u.path == paths[i].path) u.start = std::clamp(values[i], u.lower, u.upper);
    }
  }
}

Fitted fit_from(const RefitSetup& setup, const Candidate& candidate, const std::vector<Unknown>& unknowns,
                int starts) {
  std::vector<double> values;
  values.reserve(unknowns.size());
  for (const Unknown& u : unknowns) values.push_back(u.start);
  FitOptions options;
  options.jobs = setup.jobs;
  options.max_iterations = setup.max_iterations;
  options.starts = starts;
  options.seed = setup.seed;
  options.coarse = setup.coarse;
  options.profile = setup.profile && !setup.coarse;
  options.finish_undamped = setup.finish_undamped;
  options.robust = setup.robust;
  options.stop = setup.stop;
  const Candidate start = with_values(candidate, unknowns, values);
  return fitted(*setup.splits, *setup.unweighted, fit(*setup.predictor, start, unknowns, options),
                setup.jobs);
}

// The effect a tenth as strong: near neutral, yet with derivatives by its shapes (at neutral they are zero).
EffectUse near_neutral(const EffectUse& use) {
  constexpr double kTenth = 0.1;  // of the strength; a choice, sensitivity not measured
  EffectUse out = use;
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    const EffectParam& row = use.entry->info->params[i];
    if (row.role != ParamRole::kShape) out.values[i] = row.neutral + kTenth * (use.values[i] - row.neutral);
  }
  return out;
}

// The effect of a fit as a search would start it, if one of its forms ended at a bound: at its limit (no inductance, a sharp edge)
// a law is another one, and the base parameters have settled to that. Empty: none ended there.
std::optional<EffectUse> off_its_limits(const FitResult& fit, const std::string& effect) {
  const EffectUse* use = use_of(fit.model, effect);
  if (use == nullptr) return std::nullopt;
  for (const EffectParam& row : use->entry->info->params) {
    const std::string path = effect + "." + param_key(row, fit.model.file.linear);
    const bool at_bound = std::ranges::any_of(
        fit.parameters, [&](const ParameterEstimate& p) { return p.path == path && p.at_bound; });
    if (!at_bound || row.role != ParamRole::kShape || row.trait != ParamTrait::kForm) continue;
    const DriveParams<double> drive = drive_of(fit.model);
    return typical_use(*use->entry, &drive);
  }
  return std::nullopt;
}

// The same model, one effect's strength changed by a factor.
Candidate with_strength_times(const Candidate& model, const std::string& effect, double factor) {
  Candidate out = model;
  for (EffectUse& use : out.effects) {
    if (use.entry->info->id != effect) continue;
    const std::size_t row = first_strength(*use.entry->info);
    const double neutral = use.entry->info->params[row].neutral;
    use.values[row] = neutral + factor * (use.values[row] - neutral);
  }
  return out;
}

// Resets base parameters that are neither identifiable nor correlated with others to the parent's estimates:
// the data say nothing of them, and a random change would raise the error of another kind of motion.
Fitted reset_unidentifiable(const RefitSetup& setup, const Fitted& parent, Fitted child) {
  // Largest relative energy after the reset: a fifteenth of the smallest gain of interest. Tuned on the open
  // cases; sensitivity not measured.
  constexpr double kFree = 1.002;  // tuned
  const Fitted as_fitted = child;
  for (std::size_t i = 0; i < as_fitted.fit.parameters.size() && as_fitted.finite; ++i) {
    const ParameterEstimate& p = as_fitted.fit.parameters[i];
    const std::optional<double> was = value_at(parent.fit.model, p.path);
    if (i >= as_fitted.fit.unknowns.size() || as_fitted.fit.unknowns[i].effect >= 0) break;
    if (p.identifiable || !p.correlated_with.empty() || !was || *was == p.value) continue;
    FitResult fit = child.fit;
    fit.model = with_values(fit.model, {&as_fitted.fit.unknowns[i], 1}, {&*was, 1});
    fit.parameters[i].value = *was;
    fit.parameters[i].prior_deviation_sigmas = prior_z(p, *was);
    Fitted reset = fitted(*setup.splits, *setup.unweighted, std::move(fit), setup.jobs);
    const WhitenedResiduals& residuals = (*setup.splits)[kTraining];
    if (reset.finite &&
        energy_ratio(residuals, as_fitted.residual[kTraining], reset.residual[kTraining]) <= kFree)
      child = std::move(reset);
  }
  return child;
}

double fit_ratio(const RefitSetup& setup, const Fitted& parent, const Fitted& child) {
  if (!child.finite) return 1e300;
  return energy_ratio((*setup.splits)[kTraining], parent.residual[kTraining], child.residual[kTraining]);
}

// Does the child leave more than the sensors' noise in what the addition changes?
bool leaves_structure(const RefitSetup& setup, const Fitted& parent, const Fitted& child) {
  if (setup.null == nullptr || !child.finite) return false;
  const WhitenedResiduals& fit = (*setup.splits)[kTraining];
  const Eigen::VectorXd &before = parent.residual[kTraining], &left = child.residual[kTraining];
  return floor_share(fit, *setup.null, left, weights_for(fit, *setup.null, before, left)) < kNearNoise;
}

}  // namespace

Candidate at_priors(const Candidate& model, const Candidate& nominal) {
  std::vector<Unknown> base = unknowns_with_priors(model, nominal);
  std::erase_if(base, [](const Unknown& u) { return u.effect >= 0 || u.prior_sigma <= 0.0; });
  std::vector<double> values;
  values.reserve(base.size());
  for (const Unknown& u : base) values.push_back(u.prior_mean);
  return with_values(model, base, values);
}

EffectUse at_typical_size(const EffectUse& use, const Candidate& model) {
  EffectUse out = use;
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    const EffectParam& row = use.entry->info->params[i];
    if (row.role != ParamRole::kStrength) continue;
    const ParamRange range = param_range(row, model);
    out.values[i] = std::clamp(row.neutral + visible_size(row, model), range.lower, range.upper);
  }
  return out;
}

std::vector<Unknown> unknowns_with_priors(const Candidate& candidate, const Candidate& nominal) {
  std::vector<Unknown> unknowns = unknowns_of(candidate);
  const std::vector<Unknown> at_priors = unknowns_of(nominal);
  for (Unknown& u : unknowns) {
    const auto from =
        std::find_if(at_priors.begin(), at_priors.end(), [&](const Unknown& b) { return b.path == u.path; });
    if (from == at_priors.end()) continue;
    u.prior_mean = from->prior_mean;
    u.prior_sigma = from->prior_sigma;
    u.prior_form = from->prior_form;
    u.scale = from->scale;
    u.lower = from->lower;
    u.upper = from->upper;
    u.start = std::clamp(u.start, u.lower, u.upper);
  }
  return unknowns;
}

Fitted refit(const RefitSetup& of_iteration, const Fitted& parent, const Screened& effect) {
  const std::string aliased = effect.aliased_parameter();
  const bool base_implausible = is_implausible(parent.fit);
  RefitSetup setup = of_iteration;
  setup.finish_undamped = base_implausible || is_prior_rejected(parent.fit, aliased);
  const Candidate with = with_use(parent.fit.model, effect.start);
  std::vector<Unknown> unknowns = unknowns_with_priors(with, *setup.nominal);
  start_at(unknowns, effect.base_unknowns, effect.base_start);
  Fitted best = fit_from(setup, with, unknowns, 1);
  // In the residual alone: what base parameters nearer their priors gain does not show there.
  const double promised = effect.data_share();
  const double expected = 1.0 - kOfPredicted * promised, with_priors = 1.0 - kOfPredicted * effect.share;
  double ratio = fit_ratio(setup, parent, best);
  const auto stopped = [&] { return setup.stop && setup.stop(); };
  const auto restores = [&](const Fitted& f, double r) {
    return r <= 1.0 + kMostEnergyRise && !restores_prior(parent.fit, f.fit, aliased).empty();
  };
  const auto also_from = [&](const Candidate& start) {
    Fitted next = fit_from(setup, start, unknowns_with_priors(start, *setup.nominal), 1);
    const double next_ratio = fit_ratio(setup, parent, next);
    const bool was = restores(best, ratio), is = restores(next, next_ratio);
    // An optimum that restores a base parameter to its prior is preferred up to kMostEnergyRise more energy.
    const double handicap = was == is ? 0.0 : (is ? kMostEnergyRise : -kMostEnergyRise);
    if (next_ratio >= ratio + handicap) return;
    best = std::move(next);
    ratio = next_ratio;
  };
  const EffectUse typical = at_typical_size(effect.start, with);
  if (ratio > expected && !stopped()) also_from(with_use(parent.fit.model, near_neutral(effect.start)));
  if (ratio > expected && promised >= kWorthTypicalStart && !stopped())
    also_from(with_use(parent.fit.model, typical));
  if (promised >= kWorthPriorStart && leaves_structure(setup, parent, best) && !stopped()) {
    const std::optional<EffectUse> inside = off_its_limits(best.fit, effect.name);
    if (inside) also_from(with_use(parent.fit.model, *inside));
  }
  // If the base parameters have absorbed the effect, the optimiser stays near zero strength, or leaves them
  // absorbed beside the effect: also start from the nominal base, the effect at its typical size or as
  // estimated.
  if (ratio > with_priors && effect.share >= kWorthPriorStart && base_implausible && !stopped())
    also_from(with_use(at_priors(parent.fit.model, *setup.nominal), typical));
  if (base_implausible && best.finite && is_implausible(best.fit) && !stopped())
    also_from(at_priors(best.fit.model, *setup.nominal));
  // Impacts make many local optima: also from half and twice the strength.
  const bool many_optima =
      (effect.start.entry->info->numerics & kImpacts) != 0 && ratio < 1.0 - kWorthTypicalStart;
  for (const double factor : {0.5, 2.0}) {
    if (many_optima && !stopped()) also_from(with_strength_times(best.fit.model, effect.name, factor));
  }
  if (promised >= kWorthTypicalStart && leaves_structure(setup, parent, best) && !stopped()) {
    const std::optional<Candidate> lower = below_on_strength_grid(
        setup, at_priors(best.fit.model, *setup.nominal), effect.name, best.residual[kTraining]);
    if (lower) also_from(*lower);
  }
  best = reset_unidentifiable(setup, parent, std::move(best));
  if (ratio > 1.0 && !restores(best, ratio)) {
    // The parent, with the effect neutral, is a member of the larger family.
    FitResult same = parent.fit;
    best = {.fit = std::move(same),
            .residual = parent.residual,
            .unweighted = parent.unweighted,
            .finite = parent.finite};
  }
  return best;
}

Fitted refit_as_it_is(const RefitSetup& setup, const Candidate& model, int starts) {
  return fit_from(setup, model, unknowns_with_priors(model, *setup.nominal), starts);
}

Fitted refit_to_convergence(const RefitSetup& setup, Fitted model) {
  // By cost; and the fall of the energy that is worth a repeat, a sixth of the smallest gain of interest as
  // is the numerical error allowed to a simulation (DECISIONS 42). Tuned on the open cases; sensitivity not
  // measured.
  constexpr int kMostRepeats = 3;          // by cost
  constexpr double kWorthAnother = 0.005;  // tuned
  for (int k = 0; k < kMostRepeats && model.finite && !(setup.stop && setup.stop()); ++k) {
    Fitted further = refit_as_it_is(setup, model.fit.model, 1);
    const double ratio = fit_ratio(setup, model, further);
    if (ratio < 1.0) model = std::move(further);
    if (ratio > 1.0 - kWorthAnother) break;
  }
  return model;
}

}  // namespace omnihil
