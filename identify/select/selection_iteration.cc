#include "identify/select/selection_iteration.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "identify/compare/order_spectrum.h"
#include "identify/record/parallel.h"
#include "identify/record/statistics.h"
#include "identify/select/idle_effect.h"
#include "identify/select/plausibility.h"
#include "identify/select/selection.h"

namespace omnihil {
namespace {

// Length of the shortlist, by cost: a refit takes seconds. Tuned on the open cases; sensitivity not measured.
constexpr std::size_t kMostRefits = 6;  // by cost
// Screened share of the residual's energy, of all or of one regime's, that is worth a refit: a fifteenth of
// the smallest gain of interest, since the screening is linear. Tuned on the open cases; sensitivity not
// measured.
constexpr double kLeastShare = 0.002;       // tuned
constexpr double kLeastRegimeShare = 0.05;  // tuned
// Screened share from which a candidate beyond the shortlist is refitted if no candidate of the shortlist is accepted. A
// choice: the share that counts as structure (verdict.cc); smaller ones would be many tests for little.
constexpr double kWorthSecondBatch = 0.1;  // a choice
// The same as long as nothing has been found at all: nothing is masked then, and less than the smallest gain of interest (3 %)
// could not be accepted.
constexpr double kWorthFirstAnswer = 0.03;  // derived
// Gain over the null's from which a candidate is refitted: that of the acceptance test (DECISIONS 52).
constexpr double kLeastSignalToNull = 2.0;  // tuned, as the acceptance test's
// An effect whose typical size would gain less than this many times the null's largest gain is not visible:
// derived, at 1 it cannot be told from chance.
constexpr double kVisibleSignalToNull = 1.0;  // derived

// Of the best gain: a candidate that came to less is not looked at again beside a better parent. Four times the loss of gain
// up to which an effect may be meant in place of the best (selection.cc). A choice.
constexpr double kNearBest = 0.5;  // a choice

DataScale scale_of(const SelectionTask& task, const Fitted& parent, const LinearBase& base) {
  DataScale scale;
  const WhitenedResiduals& fit = (*task.splits)[kTraining];
  const auto top = [&](const char* name) {
    const Eigen::VectorXd track = fit.track(parent.fit.model, name);
    return largest_size({track.data(), static_cast<std::size_t>(track.size())});
  };
  scale.top_speed_rad_s = top("speed");
  scale.top_current_A = top("abs_current");
  for (const int run : fit.runs()) {
    scale.duration_s = std::max(scale.duration_s, task.predictor->run(run).duration_s());
  }
  for (const OrderPeak& p : strong_orders(*task.predictor, fit, parent.fit.model, base.residual(), 4)) {
    scale.orders.push_back(p.order);
  }
  return scale;
}

// Weights of the screening: each channel by its present root mean square residual, at least its noise, so
// that all count the same however well the model explains each.
Eigen::VectorXd scales_now(const SelectionTask& task, const Fitted& parent) {
  Eigen::VectorXd scale = (*task.splits)[kTraining].mean_square(parent.residual[kTraining]).cwiseSqrt();
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    scale[k] = std::max(scale[k], task.channels->noise_sigma[static_cast<std::size_t>(k)]);
  }
  return scale;
}

// Of the model's angle's rate, rad/s at the output; 0 where a sensor reports the angle, or none the speed; infinite where
// nothing tells the angle.
double speed_error(const SelectionTask& task, const Fitted& parent) {
  const AngleSource source = angle_source(*task.dataset);
  if (source == AngleSource::kSensor) return 0.0;
  if (source == AngleSource::kNone) return std::numeric_limits<double>::infinity();
  const std::vector<std::string>& names = task.channels->name;
  const auto speed =
      static_cast<Eigen::Index>(std::find(names.begin(), names.end(), "velocity") - names.begin());
  const Eigen::VectorXd& mean_square = parent.unweighted[kTraining];
  return speed < mean_square.size() ? std::sqrt(mean_square[speed]) : 0.0;
}

std::vector<const EffectEntry*> not_yet(const SelectionTask& task, const Candidate& model) {
  std::vector<const EffectEntry*> out;
  for (const EffectEntry* e : task.applicable) {
    if (use_of(model, e->info->id) == nullptr) out.push_back(e);
  }
  return out;
}

// The laws that the shortlisted ones become at a limit of their shapes: a richer law has to be better than
// these, so they are fitted beside it.
void add_nested(const std::vector<Screened>& screened, const std::vector<std::size_t>& order,
                std::vector<std::size_t>& out) {
  for (std::size_t n = 0; n < out.size(); ++n) {
    for (const std::size_t i : order) {
      const bool nested = nests(*screened[out[n]].entry->info, screened[i].name);
      if (nested && std::find(out.begin(), out.end(), i) == out.end()) out.push_back(i);
    }
  }
}

// What the screening takes for more than the null, the largest gain first; a signature found comes before any gain.
std::vector<std::size_t> above_null(const std::vector<Screened>& screened, const Predictor& predictor) {
  std::vector<std::size_t> order;
  const auto has_signature = [&](std::size_t i) { return predictor.shows_signature_of(*screened[i].entry); };
  for (std::size_t i = 0; i < screened.size(); ++i) {
    const Screened& s = screened[i];
    const bool above = s.gain > kLeastSignalToNull * s.null_gain &&
                       (s.share > kLeastShare || s.best_regime_share > kLeastRegimeShare);
    if (s.tried && s.is_resolved() && (above || has_signature(i))) order.push_back(i);
  }
  const auto rank = [&](std::size_t i) { return std::pair(has_signature(i), screened[i].share); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) > rank(b); });
  return order;
}

// Shortlist: largest screened gain overall, largest per regime, quantisation signature found, or aliased with
// a prior-implausible base parameter.
std::vector<std::size_t> shortlist(const std::vector<Screened>& screened, const Fitted& parent,
                                   const Predictor& predictor) {
  const std::vector<std::size_t> order = above_null(screened, predictor);
  std::vector<std::size_t> out;
  for (const std::size_t i : order) {
    if (out.size() < kMostRefits - 1) out.push_back(i);
  }
  for (std::size_t i = 0; i < screened.size(); ++i) {
    const bool absorbed =
        screened[i].is_resolved() && is_prior_rejected(parent.fit, screened[i].aliased_parameter());
    if (absorbed && std::find(out.begin(), out.end(), i) == out.end()) out.push_back(i);
  }
  const auto in_regime = std::max_element(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return screened[a].best_regime_share < screened[b].best_regime_share;
  });
  if (in_regime != order.end() && std::find(out.begin(), out.end(), *in_regime) == out.end())
    out.push_back(*in_regime);
  add_nested(screened, order, out);
  return out;
}

// The screening's gain over the null's: over the largest that this effect had there, or half of the largest
// that any had. Half: with kLeastSignalToNull = 2 the gain has to exceed what any effect had (DECISIONS 52).
double signal_to_null(const Screened& s, double largest_null_gain) {
  return s.gain / std::max({s.null_gain, 0.5 * largest_null_gain, 1e-300});
}

double largest_null_gain_of(const std::vector<Screened>& screened) {
  double most = 0.0;
  for (const Screened& s : screened) most = std::max(most, s.null_gain);
  return most;
}

void judge(const SelectionTask& task, const Fitted& parent, double largest_null_gain, CandidateEffect& c) {
  c.acceptance =
      test_acceptance(task.acceptance_context, parent, c.fitted, c.screened.name,
                      signal_to_null(c.screened, largest_null_gain), c.screened.aliased_parameter());
  if (c.acceptance.accepted_by == AcceptedBy::kGain) c.acceptance.refuse(c.not_its_own);
}

void refit_shortlist(const SelectionTask& task, const Fitted& parent, const std::vector<std::size_t>& chosen,
                     Iteration& iteration) {
  const std::size_t before = iteration.candidates.size();
  iteration.candidates.resize(before + chosen.size());
  std::atomic<int> done{0};
  std::atomic<bool> stopped{false};
  parallel_for(task.jobs, static_cast<int>(chosen.size()), [&](int n) {
    CandidateEffect& c = iteration.candidates[before + static_cast<std::size_t>(n)];
    c.screened = iteration.screened[chosen[static_cast<std::size_t>(n)]];
    if (stopped) return;
    RefitSetup setup{.predictor = task.predictor,
                     .splits = task.splits,
                     .unweighted = task.unweighted,
                     .nominal = task.nominal,
                     .null = task.null,
                     .seed = task.seed,
                     .stop = [&] { return stopped.load(); }};
    c.fitted = refit(setup, parent, c.screened);
    if (c.fitted.finite && !c.screened.extends)
      c.not_its_own = gain_not_its_own((*task.splits)[kTraining], c.fitted, c.screened.name, 1);
    judge(task, parent, iteration.largest_null_gain, c);
    if (c.not_its_own.empty()) {
      auto held = accepted_at_belief(task, setup, parent, c.fitted, c.acceptance, c.screened.name,
                                     signal_to_null(c.screened, iteration.largest_null_gain));
      if (held) c.acceptance = std::move(*held);
    }
    const double share = 0.5 + 0.5 * ++done / static_cast<double>(chosen.size());
    if (task.progress && !task.progress("refitting " + c.screened.name, share)) stopped = true;
  });
  iteration.stopped = stopped;
}

// Is this screened gain above the null's, as the acceptance test asks? A refit does not change the answer.
bool passes_null(const Screened& s, double largest_null_gain) {
  return signal_to_null(s, largest_null_gain) >= kLeastSignalToNull;
}

bool was_refitted(const Iteration& iteration, const Screened& s) {
  return std::any_of(iteration.candidates.begin(), iteration.candidates.end(),
                     [&](const CandidateEffect& c) { return c.screened.name == s.name; });
}

// Effects that were not refitted, listed as confusable with the best candidate, since the screening is linear and may have
// underrated them (DECISIONS 53), or whose signal in these data is its signal and whose share is as large. Not those
// that would be refused whatever the refit gains: they do not pass the null, and no base parameter is off its prior that they could
// restore.
std::vector<std::size_t> confounded_with_best(const Iteration& iteration, const Fitted& parent,
                                              bool has_holdout) {
  const CandidateEffect* best = nullptr;
  for (const CandidateEffect& c : iteration.candidates) {
    if (!c.acceptance.accepted() || c.screened.extends) continue;
    if (best == nullptr || penalised_gain(c, has_holdout) > penalised_gain(*best, has_holdout)) best = &c;
  }
  std::vector<std::size_t> out;
  for (std::size_t i = 0; best != nullptr && i < iteration.screened.size(); ++i) {
    const Screened& s = iteration.screened[i];
    const bool may_pass = passes_null(s, iteration.largest_null_gain) || is_implausible(parent.fit) ||
                          is_prior_rejected(parent.fit, s.aliased_parameter());
    const bool collinear = s.share > (1.0 - kConfoundedGain) * best->screened.share &&
                           cosine_similarity(best->screened, s) > kConfoundedCosine;
    if (may_pass && s.tried && s.is_resolved() && !s.extends && !was_refitted(iteration, s) &&
        (collinear || listed_as_confounded(*best->screened.entry->info, *s.entry->info)))
      out.push_back(i);
  }
  return out;
}

// The next ones beyond the shortlist by their screened share: what could remove a tenth of the error must not be
// passed over for what was fitted before it and failed.
std::vector<std::size_t> next_in_order(const Iteration& iteration, const Predictor& predictor, double worth) {
  std::vector<std::size_t> out;
  for (const std::size_t i : above_null(iteration.screened, predictor)) {
    const Screened& s = iteration.screened[i];
    if (out.size() < kMostRefits && s.data_share() >= worth && !was_refitted(iteration, s)) out.push_back(i);
  }
  return out;
}

bool has_accepted(const Iteration& iteration) {
  return std::any_of(iteration.candidates.begin(), iteration.candidates.end(),
                     [](const CandidateEffect& c) { return c.acceptance.accepted(); });
}

Visibility visibility_of(const Screened& s, double largest_null_gain) {
  if (!s.is_resolved()) return Visibility::kUnresolved;
  if (!s.tried) return Visibility::kNotTried;
  if (!(s.typical_gain <= kVisibleSignalToNull * largest_null_gain)) return Visibility::kVisible;
  const bool aliased = s.residual_fraction < kAliasedFraction && !s.closest_parameter.empty();
  return aliased ? Visibility::kAliased : Visibility::kBelowNoise;
}

std::string reason_of_screening(const Screened& s, Visibility visibility) {
  switch (visibility) {
    case Visibility::kNotTried:
      return "not tried";
    case Visibility::kAliased:
      return fmt::format("not visible in these data: {} produces the same signal", s.closest_parameter);
    case Visibility::kBelowNoise:
      return "not visible in these data: at its typical size it gains no more than in the simulated null";
    case Visibility::kUnresolved:
      return std::string(s.tried ? kPhaseUnresolved : kNoPhase);
    case Visibility::kVisible:
      break;
  }
  return s.share > kLeastShare ? fmt::format("could remove {:.1f} % of the error energy; others remove more",
                                             100.0 * std::clamp(s.data_share(), 0.0, 1.0))
                               : "would remove less of the error energy than is worth a refit";
}

RankedEffect ranked(const Screened& s, double largest_null_gain) {
  RankedEffect r;
  r.effect = s.name;
  r.score = s.share;
  r.signal_to_null = signal_to_null(s, largest_null_gain);
  r.visibility = visibility_of(s, largest_null_gain);
  r.why = reason_of_screening(s, r.visibility);
  return r;
}

void make_ranking(const SelectionTask& task, const Fitted& parent, Iteration& iteration) {
  std::vector<std::string> refitted;
  for (const CandidateEffect& c : iteration.candidates) {
    RankedEffect r = ranked(c.screened, iteration.largest_null_gain);
    r.refitted = true;
    r.visibility = Visibility::kVisible;
    r.accepted_by = c.acceptance.accepted_by;
    r.plausible = c.acceptance.plausible;
    r.share_of_base = c.acceptance.share_of_base;
    r.evidence = c.acceptance.evidence;
    r.why = c.acceptance.why;
    r.selection_frequency = c.selection_frequency;
    r.parameters = parameters_of(c.fitted.fit, c.screened.name);
    const auto ratio = [&](std::size_t u) {
      const WhitenedResiduals& residuals = (*task.splits)[u];
      if (residuals.empty() || !c.fitted.finite) return 1.0;
      return pooled_error(residuals, *task.channels, c.fitted.residual[u]) /
             std::max(pooled_error(residuals, *task.channels, parent.residual[u]), 1e-300);
    };
    r.fit_error_ratio = ratio(0);
    r.holdout_error_ratio = ratio(1);
    r.extrapolation_error_ratio = ratio(2);
    refitted.push_back(c.screened.name);
    iteration.ranking.push_back(std::move(r));
  }
  std::vector<RankedEffect> others;
  for (const RankedEffect& r : iteration.earlier) {
    iteration.ranking.push_back(r);
    refitted.push_back(r.effect);
  }
  for (const Screened& s : iteration.screened) {
    if (std::find(refitted.begin(), refitted.end(), s.name) == refitted.end()) {
      others.push_back(ranked(s, iteration.largest_null_gain));
    }
  }
  std::stable_sort(others.begin(), others.end(),
                   [](const RankedEffect& a, const RankedEffect& b) { return a.score > b.score; });
  iteration.ranking.insert(iteration.ranking.end(), others.begin(), others.end());
}

// Candidates whose gain is near that of the chosen one, and the laws that it becomes at a limit of its shapes.
std::vector<const CandidateEffect*> near_best(const Iteration& iteration, bool has_holdout) {
  const CandidateEffect& best = iteration.candidates[static_cast<std::size_t>(iteration.chosen)];
  const double least = kNearBest * penalised_gain(best, has_holdout);
  std::vector<const CandidateEffect*> out;
  for (const CandidateEffect& c : iteration.candidates) {
    const bool near = &c == &best || penalised_gain(c, has_holdout) >= least ||
                      nests(*best.screened.entry->info, c.screened.name);
    if (c.fitted.finite && near) out.push_back(&c);
  }
  return out;
}

// What the screening says of it now, with its own fit for a start.
Screened from_own_fit(Screened screened, const CandidateEffect& c) {
  const Candidate& model = c.fitted.fit.model;
  const auto use = std::ranges::find(model.effects, screened.entry, &EffectUse::entry);
  if (use == model.effects.end()) return screened;
  screened.start = *use;
  screened.base_unknowns = c.fitted.fit.unknowns;
  screened.base_start.clear();
  for (const Unknown& u : screened.base_unknowns)
    screened.base_start.push_back(value_at(model, u.path).value_or(u.start));
  return screened;
}

void choose_anew(const SelectionTask& task, const Fitted& parent, Iteration& iteration) {
  iteration.chosen = -1;
  iteration.confounded.clear();
  iteration.ranking.clear();
  for (CandidateEffect& c : iteration.candidates) c.selection_frequency = 0.0;
  select_best(task, parent, iteration);
  make_ranking(task, parent, iteration);
}

}  // namespace

std::vector<ParameterEstimate> parameters_of(const FitResult& fit, const std::string& effect) {
  std::vector<ParameterEstimate> out;
  for (const ParameterEstimate& p : fit.parameters) {
    if (!p.path.starts_with(effect + ".")) continue;
    out.push_back(p);
    out.back().path = p.path.substr(effect.size() + 1);
  }
  return out;
}

Iteration screening_iteration(const SelectionTask& task, const Fitted& parent,
                              const std::vector<const EffectEntry*>& effects) {
  Iteration iteration;
  const WhitenedResiduals& fit = (*task.splits)[kTraining];
  const LinearBase base(fit, parent.fit.model, unknowns_with_priors(parent.fit.model, *task.nominal),
                        scales_now(task, parent), task.jobs);
  if (!base.usable()) return iteration;
  ScreeningTask screening;
  screening.residuals = &fit;
  screening.model = &parent.fit.model;
  screening.base = &base;
  const Candidate from_priors = at_priors(parent.fit.model, *task.nominal);
  screening.at_priors = &from_priors;
  for (const Eigen::VectorXd& n : task.null->fit_noise)
    screening.noise.push_back(n.cwiseProduct(base.weights()));
  screening.regimes = regime_masks(fit, parent.fit.model);
  screening.scale = scale_of(task, parent, base);
  screening.drift = angle_drift(fit, parent.fit.model, speed_error(task, parent));
  screening.jobs = task.jobs;
  screening.progress = [&](double share) {
    return !task.progress || task.progress("screening", 0.5 * share);
  };
  iteration.orders = screening.scale.orders;
  iteration.screened = screen(screening, effects);
  for (Screened& s : screen_extensions(screening)) iteration.screened.push_back(std::move(s));
  iteration.largest_null_gain = largest_null_gain_of(iteration.screened);
  return iteration;
}

void refuse_chosen(const SelectionTask& task, const Fitted& parent, const std::string& why,
                   Iteration& iteration) {
  iteration.candidates[static_cast<std::size_t>(iteration.chosen)].acceptance.refuse(why);
  choose_anew(task, parent, iteration);
}

Iteration refitted_as_well(const SelectionTask& task, const Fitted& parent,
                           const std::vector<std::size_t>& screened, Iteration iteration) {
  std::vector<std::size_t> further;
  std::ranges::copy_if(screened, std::back_inserter(further),
                       [&](std::size_t i) { return !was_refitted(iteration, iteration.screened[i]); });
  if (!further.empty()) refit_shortlist(task, parent, further, iteration);
  return iteration;
}

Iteration iteration_among(const SelectionTask& task, const Fitted& parent,
                          const std::vector<const EffectEntry*>& effects) {
  Iteration iteration = screening_iteration(task, parent, effects);
  std::vector<std::size_t> all(iteration.screened.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  refit_shortlist(task, parent, all, iteration);
  choose_anew(task, parent, iteration);
  return iteration;
}

void judge_anew(const SelectionTask& task, const Fitted& parent, Iteration& iteration) {
  for (CandidateEffect& c : iteration.candidates) judge(task, parent, iteration.largest_null_gain, c);
  choose_anew(task, parent, iteration);
}

std::optional<Iteration> near_best_again(const SelectionTask& task, const Fitted& parent,
                                         const Iteration& before) {
  const std::vector<const CandidateEffect*> near = near_best(before, !(*task.splits)[kValidation].empty());
  if (std::ranges::any_of(near, [](const CandidateEffect* c) { return c->screened.extends; }))
    return std::nullopt;
  std::vector<const EffectEntry*> effects;
  for (const CandidateEffect* c : near) effects.push_back(c->screened.entry);
  Iteration iteration = screening_iteration(task, parent, effects);
  if (iteration.screened.size() < near.size()) return std::nullopt;
  iteration.largest_null_gain = std::max(iteration.largest_null_gain, before.largest_null_gain);
  iteration.stopped = task.progress && !task.progress("screening", 0.5);
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < near.size(); ++k) {
    iteration.screened[k] = from_own_fit(std::move(iteration.screened[k]), *near[k]);
    chosen.push_back(k);
  }
  if (!iteration.stopped) refit_shortlist(task, parent, chosen, iteration);
  const auto is_near = [&](const RankedEffect& r) {
    return std::ranges::any_of(near, [&](const CandidateEffect* c) { return c->screened.name == r.effect; });
  };
  std::ranges::remove_copy_if(before.ranking, std::back_inserter(iteration.earlier), is_near);
  for (RankedEffect& r : iteration.earlier) {
    constexpr std::string_view kThen = "far from the best, beside a model that fitted worse: ";
    if (!r.refitted || r.why.starts_with(kThen)) continue;
    r.accepted_by = AcceptedBy::kNone;  // not tested beside this parent
    r.why.insert(0, kThen);
  }
  choose_anew(task, parent, iteration);
  return iteration;
}

Iteration selection_iteration(const SelectionTask& task, const Fitted& parent) {
  Iteration iteration = screening_iteration(task, parent, not_yet(task, parent.fit.model));
  iteration.stopped = task.progress && !task.progress("screening", 0.5);
  if (!iteration.stopped)
    refit_shortlist(task, parent, shortlist(iteration.screened, parent, *task.predictor), iteration);
  const bool nothing_yet = parent.fit.model.effects.size() == task.nominal->effects.size();
  const double worth = nothing_yet ? kWorthFirstAnswer : kWorthSecondBatch;
  for (bool more = true; more && !iteration.stopped && !has_accepted(iteration);) {
    const std::vector<std::size_t> next = next_in_order(iteration, *task.predictor, worth);
    more = !next.empty();
    if (more) refit_shortlist(task, parent, next, iteration);
  }
  if (!iteration.stopped)
    refit_shortlist(task, parent,
                    confounded_with_best(iteration, parent, !(*task.splits)[kValidation].empty()), iteration);
  select_best(task, parent, iteration);
  make_ranking(task, parent, iteration);
  return iteration;
}

}  // namespace omnihil
