#include "identify/select/addition_round.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "identify/compare/order_spectrum.h"
#include "identify/record/parallel.h"
#include "identify/select/contest.h"
#include "identify/select/soundness.h"

namespace omnihil {
namespace {

constexpr std::size_t kMostRefits = 6;
constexpr double kLeastShare = 0.002;       // of the residual's energy, to be worth a refit
constexpr double kLeastRegimeShare = 0.05;  // of that of one regime
constexpr double kNotSeen = 1.0;            // typical size gains less than chance

DataScale scale_of(const Search& search, const Fitted& parent, const LinearBase& base) {
  DataScale scale;
  const Evidence& fit = (*search.uses)[0];
  const auto top = [&](const char* name) {
    double most = 0.0;
    for (const double v : fit.track(parent.fit.model, name)) {
      if (std::isfinite(v)) most = std::max(most, std::abs(v));
    }
    return most;
  };
  scale.top_speed_rad_s = top("speed");
  scale.top_current_A = top("abs_current");
  for (const int run : fit.runs()) {
    scale.duration_s = std::max(scale.duration_s, search.predictor->run(run).duration_s());
  }
  for (const OrderPeak& p : strong_orders(*search.predictor, fit, parent.fit.model, base.residual(), 4)) {
    scale.orders.push_back(p.order);
  }
  return scale;
}

// Signals weigh the same however well the model explains each: by what it leaves now.
Eigen::VectorXd scales_now(const Search& search, const Fitted& parent) {
  Eigen::VectorXd scale = (*search.uses)[0].mean_square(parent.residual[0]).cwiseSqrt();
  for (Eigen::Index k = 0; k < scale.size(); ++k) {
    scale[k] = std::max(scale[k], search.kinds->noise_sigma[static_cast<std::size_t>(k)]);
  }
  return scale;
}

std::vector<const EffectEntry*> not_yet(const Search& search, const Candidate& model) {
  std::vector<const EffectEntry*> out;
  for (const EffectEntry* e : search.applicable) {
    const bool has = std::any_of(model.effects.begin(), model.effects.end(),
                                 [&](const EffectUse& u) { return u.entry->info->id == e->info->id; });
    if (!has) out.push_back(e);
  }
  return out;
}

// Which of the screened are refitted: the largest shares, whoever is largest in a regime, whose mark the
// readings carry, and what a base parameter imitates that is not what its file says.
std::vector<std::size_t> nominees(const std::vector<Screened>& screened, const Fitted& parent,
                                  const Predictor& predictor) {
  std::vector<std::size_t> order, out;
  const auto marked = [&](std::size_t i) { return predictor.carries_mark_of(*screened[i].entry); };
  for (std::size_t i = 0; i < screened.size(); ++i) {
    const Screened& s = screened[i];
    const bool above_chance =
        s.gain > 2.0 * s.null_gain && (s.share > kLeastShare || s.best_regime_share > kLeastRegimeShare);
    if (s.tried && (above_chance || marked(i))) order.push_back(i);
  }
  const auto rank = [&](std::size_t i) {
    return std::pair(marked(i), screened[i].share);  // whose mark the readings carry comes before all
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) > rank(b); });
  for (const std::size_t i : order) {
    if (out.size() < kMostRefits - 1) out.push_back(i);
  }
  for (std::size_t i = 0; i < screened.size(); ++i) {
    const bool hidden = drift_of(parent.fit, screened[i].stands_for()) >= kDisbelieved_sigmas;
    if (hidden && std::find(out.begin(), out.end(), i) == out.end()) out.push_back(i);
  }
  const auto corner = std::max_element(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return screened[a].best_regime_share < screened[b].best_regime_share;
  });
  if (corner != order.end() && std::find(out.begin(), out.end(), *corner) == out.end())
    out.push_back(*corner);
  return out;
}

// Its gain over what chance gives: the most that it gave this effect, or half the most that it gave any.
double over_chance(const Screened& s, double chance_of_any) {
  return s.gain / std::max({s.null_gain, 0.5 * chance_of_any, 1e-300});
}

double chance_of(const std::vector<Screened>& screened) {
  double most = 0.0;
  for (const Screened& s : screened) most = std::max(most, s.null_gain);
  return most;
}

void refit_nominees(const Search& search, const Fitted& parent, const std::vector<std::size_t>& chosen,
                    Round& round) {
  const std::size_t before = round.contenders.size();
  round.contenders.resize(before + chosen.size());
  std::atomic<int> done{0};
  std::atomic<bool> stopped{false};
  parallel_for(search.jobs, static_cast<int>(chosen.size()), [&](int n) {
    Contender& c = round.contenders[before + static_cast<std::size_t>(n)];
    c.screened = round.screened[chosen[static_cast<std::size_t>(n)]];
    if (stopped) return;
    RefitSetup setup{.predictor = search.predictor,
                     .uses = search.uses,
                     .seen = search.seen,
                     .nominal = search.nominal,
                     .seed = search.seed,
                     .stop = [&] { return stopped.load(); }};
    c.fitted = refit(setup, parent, c.screened);
    c.judgement = judge(search.judging, parent, c.fitted, c.screened.name,
                        over_chance(c.screened, round.chance_gain), c.screened.stands_for());
    const double share = 0.5 + 0.5 * ++done / static_cast<double>(chosen.size());
    if (search.progress && !search.progress("refitting " + c.screened.name, share)) stopped = true;
  });
  round.stopped = stopped;
}

// Effects that are known to be confused with the leading contender, and were not refitted: the screening is
// linear, and theirs may be the form that it sees worst.
std::vector<std::size_t> twins_of_leader(const Round& round, bool has_holdout) {
  const Contender* leader = nullptr;
  for (const Contender& c : round.contenders) {
    if (!c.judgement.accepted || c.screened.extends) continue;
    if (leader == nullptr || merit_of(c, has_holdout) > merit_of(*leader, has_holdout)) leader = &c;
  }
  std::vector<std::size_t> out;
  for (std::size_t i = 0; leader != nullptr && i < round.screened.size(); ++i) {
    const Screened& s = round.screened[i];
    const bool known = std::any_of(round.contenders.begin(), round.contenders.end(),
                                   [&](const Contender& c) { return c.screened.name == s.name; });
    if (s.tried && !s.extends && !known && listed_twins(*leader->screened.entry->info, *s.entry->info))
      out.push_back(i);
  }
  return out;
}

std::string unseen(const Screened& s, double chance) {
  if (!s.tried) return "not tried";
  if (s.kept < kNotParted && s.typical_gain <= kNotSeen * chance && !s.imitated_by.empty()) {
    return fmt::format("not visible in these data: {} imitates it", s.imitated_by);
  }
  if (s.typical_gain <= kNotSeen * chance) {
    return "not visible in these data: at its typical size its signal is below what the sensors' noise gives";
  }
  return "";
}

RankedEffect ranked(const Screened& s, double chance) {
  RankedEffect r;
  r.effect = s.name;
  r.score = s.share;
  r.why = unseen(s, chance);
  if (r.why.empty()) {
    r.why = s.share > kLeastShare
                ? fmt::format("could take {:.1f} % of the error energy; others take more", 100.0 * s.share)
                : "would take less of the error energy than matters";
  }
  return r;
}

void make_ranking(const Search& search, const Fitted& parent, Round& round) {
  std::vector<std::string> refitted;
  for (const Contender& c : round.contenders) {
    RankedEffect r = ranked(c.screened, round.chance_gain);
    r.refitted = true;
    r.accepted = c.judgement.accepted;
    r.why = c.judgement.why;
    r.probability = c.probability;
    r.parameters = parameters_of(c.fitted.fit, c.screened.name);
    const auto ratio = [&](std::size_t u) {
      const Evidence& evidence = (*search.uses)[u];
      if (evidence.empty() || !c.fitted.finite) return 1.0;
      return pooled_error(evidence, *search.kinds, c.fitted.residual[u]) /
             std::max(pooled_error(evidence, *search.kinds, parent.residual[u]), 1e-300);
    };
    r.fit_error_ratio = ratio(0);
    r.holdout_error_ratio = ratio(1);
    r.extrapolation_error_ratio = ratio(2);
    refitted.push_back(c.screened.name);
    round.ranking.push_back(std::move(r));
  }
  std::vector<RankedEffect> others;
  for (const Screened& s : round.screened) {
    if (std::find(refitted.begin(), refitted.end(), s.name) == refitted.end()) {
      others.push_back(ranked(s, round.chance_gain));
    }
  }
  std::stable_sort(others.begin(), others.end(),
                   [](const RankedEffect& a, const RankedEffect& b) { return a.score > b.score; });
  round.ranking.insert(round.ranking.end(), others.begin(), others.end());
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

Round screening_round(const Search& search, const Fitted& parent,
                      const std::vector<const EffectEntry*>& effects) {
  Round round;
  const Evidence& fit = (*search.uses)[0];
  const LinearBase base(fit, parent.fit.model, unknowns_with_priors(parent.fit.model, *search.nominal),
                        scales_now(search, parent), search.jobs);
  if (!base.usable()) return round;
  ScreeningTask task;
  task.evidence = &fit;
  task.model = &parent.fit.model;
  task.base = &base;
  for (const Eigen::VectorXd& n : search.null->fit_noise)
    task.noise.push_back(n.cwiseProduct(base.weights()));
  task.regimes = regime_masks(fit, parent.fit.model);
  task.scale = scale_of(search, parent, base);
  task.jobs = search.jobs;
  task.progress = [&](double share) { return !search.progress || search.progress("screening", 0.5 * share); };
  round.orders = task.scale.orders;
  round.screened = screen(task, effects);
  for (Screened& s : screen_extensions(task)) round.screened.push_back(std::move(s));
  round.chance_gain = chance_of(round.screened);
  return round;
}

Round addition_round(const Search& search, const Fitted& parent) {
  Round round = screening_round(search, parent, not_yet(search, parent.fit.model));
  round.stopped = search.progress && !search.progress("screening", 0.5);
  if (!round.stopped)
    refit_nominees(search, parent, nominees(round.screened, parent, *search.predictor), round);
  if (!round.stopped)
    refit_nominees(search, parent, twins_of_leader(round, !(*search.uses)[1].empty()), round);
  settle(search, parent, round);
  make_ranking(search, parent, round);
  return round;
}

}  // namespace omnihil
