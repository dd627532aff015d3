#include "sim/identify/judge.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sim/core/effect_reader.h"
#include "sim/core/effect_registry.h"
#include "sim/core/random.h"

namespace omnihil {
namespace {

constexpr int kDraws = 200;
// What an addition must take away from the held-out error energy that is above the sensors' floor, and of the
// whole of it. Real recordings never reach the floor: without this every effect would stay.
constexpr double kMatters = 0.03;
// More where the sensors' noise is most of what is left: a gain of a few per cent of noise is no effect.
constexpr double kMattersAtFloor = 0.05;
constexpr double kChanceMargin = 2.0;  // gain over the most that the null's replicates gave
constexpr double kPlain = 0.3;         // of the held-out error energy
constexpr double kSeen = 0.015;        // fall of some signal's error energy, noise included
constexpr double kSeenWhitened =
    0.1;  // or of the whitened: a coarse encoder hides what its count still tells
constexpr double kFloorWeight = 0.05;
constexpr double kExtrapolationLoss = 0.03;
constexpr double kSignificant_sigmas = 2.0;
constexpr double kPushedOut_sigmas = 3.5;     // of a base parameter's tolerance
constexpr double kDriftAllowed_sigmas = 0.7;  // further out than it was before

double at_share(Eigen::VectorXd values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<Eigen::Index>(share * static_cast<double>(values.size() - 1))];
}

// The largest relative fall of one signal's error energy, as somebody sees it who looks at the signal.
double gain_as_seen(const Eigen::VectorXd& parent, const Eigen::VectorXd& child) {
  double most = 0.0;
  for (Eigen::Index k = 0; k < std::min(parent.size(), child.size()); ++k) {
    if (parent[k] > 0.0) most = std::max(most, 1.0 - child[k] / parent[k]);
  }
  return most;
}

// How much more an addition leaves in a use than its parent, both counted only from where the simulated null
// ends: what measured inputs' noise makes of the slowest part of a residual goes up or down with every refit.
double rise_above_null(const Evidence& evidence, const NullModel& null, const Eigen::VectorXd& parent,
                       const Eigen::VectorXd& child) {
  const Eigen::VectorXd level = null.floor(evidence.use()) + null.spread(evidence.use());
  const Eigen::VectorXd before = evidence.mean_square(parent).cwiseMax(level),
                        after = evidence.mean_square(child).cwiseMax(level);
  const Eigen::VectorXd weights = weights_for(evidence, null, parent, child);
  double sum = 0.0;
  for (Eigen::Index k = 0; k < before.size(); ++k) {
    if (before[k] > 0.0) sum += weights[k] * (after[k] / before[k] - 1.0);
  }
  return weights.sum() > 0.0 ? sum / weights.sum() : 0.0;
}

// Of the extrapolation runs; 0 where the bootstrap does not see one, or where the signals as they are seen
// fall.
double extrapolation_rise(const JudgeContext& context, const Fitted& parent, const Fitted& child,
                          const UseGain& gain) {
  const Evidence& evidence = (*context.uses)[2];
  if (evidence.empty() || gain.best <= 1.0) return 0.0;
  const Eigen::VectorXd weights = weights_for(evidence, *context.null, parent.residual[2], child.residual[2]);
  const double seen = weights.dot(child.as_seen[2].cwiseQuotient(parent.as_seen[2].cwiseMax(1e-300)));
  if (seen < (1.0 - kExtrapolationLoss) * weights.sum()) return 0.0;
  return std::min(gain.ratio - 1.0,
                  rise_above_null(evidence, *context.null, parent.residual[2], child.residual[2]));
}

// A base parameter that the addition pushes out of its tolerance; empty: none.
std::string pushed_out(const FitResult& parent, const FitResult& child) {
  for (const ParameterEstimate& p : child.parameters) {
    if (p.prior_sigma <= 0.0 || std::abs(p.drift_sigmas) < kPushedOut_sigmas) continue;
    const auto before = std::find_if(parent.parameters.begin(), parent.parameters.end(),
                                     [&](const ParameterEstimate& q) { return q.path == p.path; });
    if (before == parent.parameters.end()) continue;  // of the effect itself
    if (std::abs(p.drift_sigmas) > std::abs(before->drift_sigmas) + kDriftAllowed_sigmas) {
      return fmt::format("it pushes {} out of its tolerance ({:+.1f} sigma, before {:+.1f})", p.path,
                         p.drift_sigmas, before->drift_sigmas);
    }
  }
  return "";
}

// A bound that says that the law is bent to something it does not mean. A strength may stay at its neutral
// value (one of several), a phase goes round, an exponent is a form.
bool misused_bound(const ParameterEstimate& p, const EffectParam* row) {
  if (!p.at_bound || row == nullptr) return false;
  if (row->role != ParamRole::kShape) return std::abs(p.value - row->neutral) > 1e-3 * std::abs(row->typical);
  return !row->name.starts_with("phase") && row->name != "exponent";
}

// Strengths together: those that trade with each other (four ratios against the scale that they share with a
// base parameter) may each be uncertain where what parts them is not. Wald's statistic, 95 % of chi-square.
bool told_together(const FitResult& child, const std::vector<Eigen::Index>& rows,
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
  constexpr double kPerFurther = 1.9;  // of the quantile, per further strength
  const double asked = kSignificant_sigmas * kSignificant_sigmas + kPerFurther * static_cast<double>(n - 1);
  return d.dot(covariance.ldlt().solve(d)) > asked;
}

// Numbers of the effect that no drive has; empty: none. `plain`: it takes so much that its strength is no
// question, however it trades against its own shapes.
std::string unphysical(const FitResult& child, const std::string& name, bool plain) {
  const EffectEntry* entry = find_effect(name);
  bool strong = entry == nullptr;
  std::vector<Eigen::Index> strengths;
  std::vector<double> away;
  for (std::size_t n = 0; n < child.parameters.size(); ++n) {
    const ParameterEstimate& p = child.parameters[n];
    if (!p.path.starts_with(name + ".")) continue;
    const std::string key = p.path.substr(name.size() + 1);
    const EffectParam* row = nullptr;
    for (std::size_t i = 0; entry != nullptr && i < entry->info->params.size(); ++i) {
      const EffectParam& r = entry->info->params[i];
      if (r.name == key || param_key(r, child.model.file.linear) == key) row = &r;
    }
    if (misused_bound(p, row)) {
      return fmt::format("{} ends at a bound ({:.4g} {}): a symptom, not a result", p.path, p.value, p.unit);
    }
    if (row == nullptr || row->role == ParamRole::kShape) continue;
    const double size = std::abs(p.value - row->neutral);
    if (p.unphysical && size > 1e-9)
      return fmt::format("{} = {:.4g} {} is not physical", p.path, p.value, p.unit);
    // With what the file knows of the base: where the data fix ratios alone (speed without current), the
    // scale of every torque comes from the tolerances.
    if (size > kSignificant_sigmas * p.sigma || p.sigma <= 0.0) strong = strong || size > 0.0;
    strengths.push_back(static_cast<Eigen::Index>(n));
    away.push_back(p.value - row->neutral);
  }
  strong = strong || told_together(child, strengths, away);
  return strong || plain ? "" : "its strength is not told from zero";
}

}  // namespace

Fitted fitted(const Uses& uses, const Uses& seen, FitResult fit, int jobs) {
  Fitted out{.fit = std::move(fit), .residual = {}, .finite = true};
  for (std::size_t u = 0; u < kUses; ++u) {
    if (uses[u].empty()) continue;
    out.residual[u] = uses[u].residual(out.fit.model, jobs);
    if (out.residual[u].size() != uses[u].size()) {
      out.finite = false;
      continue;
    }
    const Eigen::VectorXd as_seen = seen[u].residual(out.fit.model, jobs);
    if (as_seen.size() == seen[u].size()) out.as_seen[u] = seen[u].mean_square(as_seen);
  }
  return out;
}

BlockBootstrap::BlockBootstrap(const Evidence& evidence, std::uint64_t seed) : evidence_(&evidence) {
  const int blocks = evidence.blocks();
  if (blocks == 0) return;
  counts_ = Eigen::MatrixXd::Zero(kDraws, blocks);
  for (int d = 0; d < kDraws; ++d) {
    for (int b = 0; b < blocks; ++b) {
      const std::uint64_t counter = static_cast<std::uint64_t>(d) * 1000003u + static_cast<std::uint64_t>(b);
      const int drawn = static_cast<int>(uniform(seed, stream_of("bootstrap"), counter) * blocks);
      counts_(d, std::min(drawn, blocks - 1)) += 1.0;
    }
  }
}

Eigen::VectorXd BlockBootstrap::ratios(const Eigen::VectorXd& reference, const Eigen::VectorXd& residual,
                                       const Eigen::VectorXd& weights) const {
  const Eigen::MatrixXd before = counts_ * evidence_->block_sums(reference);
  const Eigen::MatrixXd after = counts_ * evidence_->block_sums(residual);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(counts_.rows());
  double all = 0.0;
  for (Eigen::Index k = 0; k < before.cols(); ++k) {
    if (weights[k] <= 0.0 || before.col(k).sum() <= 0.0) continue;
    all += weights[k];
    for (Eigen::Index d = 0; d < out.size(); ++d) {
      out[d] += weights[k] * (before(d, k) > 0.0 ? after(d, k) / before(d, k) : 1.0);
    }
  }
  return all > 0.0 ? Eigen::VectorXd(out / all) : Eigen::VectorXd::Ones(counts_.rows());
}

UseGain BlockBootstrap::gain(const Eigen::VectorXd& reference, const Eigen::VectorXd& residual,
                             const Eigen::VectorXd& weights) const {
  const Eigen::VectorXd draws = ratios(reference, residual, weights);
  return {.ratio = energy_ratio(*evidence_, reference, residual, weights),
          .best = at_share(draws, 0.05),
          .worst = at_share(draws, 0.95)};
}

Eigen::VectorXd signal_weights(const Evidence& evidence, const NullModel& null,
                               const Eigen::VectorXd& reference) {
  const Eigen::VectorXd floor = null.floor(evidence.use()), square = evidence.mean_square(reference);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(square.size());
  for (Eigen::Index k = 0; k < square.size(); ++k) {
    if (square[k] > 0.0) weights[k] = std::max(kFloorWeight, 1.0 - floor[k] / square[k]);
  }
  return weights;
}

Eigen::VectorXd weights_for(const Evidence& evidence, const NullModel& null, const Eigen::VectorXd& parent,
                            const Eigen::VectorXd& child) {
  constexpr double kUnmoved = 1e-9;
  const Eigen::VectorXd all = signal_weights(evidence, null, parent);
  if (child.size() != parent.size()) return all;
  const Eigen::VectorXd moved = evidence.mean_square(child - parent), size = evidence.mean_square(parent);
  Eigen::VectorXd weights = all;
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    if (moved[k] <= kUnmoved * size[k]) weights[k] = 0.0;
  }
  return weights.sum() > 0.0 ? weights : all;
}

double energy_ratio(const Evidence& evidence, const Eigen::VectorXd& reference,
                    const Eigen::VectorXd& residual, const Eigen::VectorXd& weights) {
  const Eigen::VectorXd before = evidence.mean_square(reference), after = evidence.mean_square(residual);
  double sum = 0.0, all = 0.0;
  for (Eigen::Index k = 0; k < before.size(); ++k) {
    if (before[k] <= 0.0) continue;
    const double weight = weights.size() > 0 ? weights[k] : 1.0;
    sum += weight * after[k] / before[k];
    all += weight;
  }
  return all > 0.0 ? sum / all : 1.0;
}

double pooled_error(const Evidence& evidence, const SignalKinds& kinds, const Eigen::VectorXd& residual) {
  const Eigen::VectorXd square = evidence.mean_square(residual);
  double sum = 0.0, signals = 0.0;
  for (int k = 0; k < kinds.count(); ++k) {
    const double sigma = kinds.noise_sigma[static_cast<std::size_t>(k)];
    if (evidence.samples()[k] <= 0.0 || sigma <= 0.0) continue;
    sum += square[k] / (sigma * sigma);
    signals += 1.0;
  }
  return signals > 0.0 ? std::sqrt(sum / signals) : 0.0;
}

double floor_share(const Evidence& evidence, const NullModel& null, const Eigen::VectorXd& residual,
                   const Eigen::VectorXd& weights) {
  if (evidence.empty()) return 1.0;
  const Eigen::VectorXd floor = null.floor(evidence.use()), square = evidence.mean_square(residual);
  double sum = 0.0;
  for (Eigen::Index k = 0; k < square.size(); ++k) {
    if (square[k] > 0.0) sum += weights[k] * std::min(1.0, floor[k] / square[k]);
  }
  return weights.sum() > 0.0 ? sum / weights.sum() : 1.0;
}

Judgement judge(const JudgeContext& context, const Fitted& parent, const Fitted& child,
                const std::string& name, double gain_over_chance) {
  Judgement out;
  if (!child.finite) {
    out.why = "the model with it does not stay finite";
    return out;
  }
  std::array<UseGain*, kUses> gains{&out.fit, &out.holdout, &out.extrapolation};
  for (std::size_t u = 0; u < kUses; ++u) {
    if ((*context.uses)[u].empty()) continue;
    const Evidence& evidence = (*context.uses)[u];
    const Eigen::VectorXd weights =
        weights_for(evidence, *context.null, parent.residual[u], child.residual[u]);
    *gains[u] = context.bootstrap[u]->gain(parent.residual[u], child.residual[u], weights);
    gains[u]->floor = floor_share(evidence, *context.null, parent.residual[u], weights);
  }
  const Use decides = (*context.uses)[1].empty() ? Use::kFit : Use::kHoldout;
  const std::size_t d = static_cast<std::size_t>(decides);
  const UseGain& held = *gains[d];
  const double needed = kMatters + kMattersAtFloor * held.floor;
  out.plain = 1.0 - held.ratio > kPlain && held.worst < 1.0;
  if (gain_over_chance < kChanceMargin) {
    out.why =
        fmt::format("its gain is {:.1f} times what chance gives in the simulated null", gain_over_chance);
  } else if (1.0 - out.fit.ratio < 0.5 * kMatters) {
    out.why = fmt::format("it lowers the error energy of the fit runs by {:.1f} % only",
                          100.0 * (1.0 - out.fit.ratio));
  } else if (1.0 - held.ratio < needed) {
    out.why =
        held.ratio > 1.0
            ? fmt::format(
                  "it lowers the error that it was fitted to, and raises the {} error energy by {:.1f} %",
                  decides == Use::kHoldout ? "held-out" : "fit", 100.0 * (held.ratio - 1.0))
            : fmt::format("it takes {:.1f} % of the held-out error energy; {:.1f} % would matter",
                          100.0 * (1.0 - held.ratio), 100.0 * needed);
  } else if (const double seen = gain_as_seen(parent.as_seen[d], child.as_seen[d]);
             seen < kSeen && 1.0 - held.ratio < kSeenWhitened) {
    out.why =
        fmt::format("no signal's error falls by more than {:.1f} % in energy as it is seen", 100.0 * seen);
  } else if (held.worst > 1.0) {
    out.why = "its gain comes from a few moments of the held-out runs alone";
  } else if (const double rise = extrapolation_rise(context, parent, child, out.extrapolation);
             rise > kExtrapolationLoss) {
    out.why = fmt::format("it raises the error energy of the extrapolation runs by {:.0f} %", 100.0 * rise);
  } else if (out.why = unphysical(child.fit, name, out.plain); !out.why.empty()) {
    return out;
  } else if (out.why = pushed_out(parent.fit, child.fit); !out.why.empty()) {
    return out;
  } else {
    out.accepted = true;
    out.why = fmt::format("held-out error energy falls by {:.1f} %", 100.0 * (1.0 - held.ratio));
  }
  return out;
}

}  // namespace omnihil
