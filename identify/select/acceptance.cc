#include "identify/select/acceptance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/select/plausibility.h"

namespace omnihil {
namespace {

// What an addition must take away from the held-out error energy that is above the sensors' floor, and of the
// whole of it. Real recordings never reach the floor: without this every effect would stay.
constexpr double kMatters = 0.03;
// More where the sensors' noise is most of what is left: a gain of a few per cent of noise is no effect.
constexpr double kMattersAtFloor = 0.05;
constexpr double kChanceMargin = 2.0;  // gain over what chance gives (selection_iteration.cc)
constexpr double kPlain = 0.3;         // of the held-out error energy
constexpr double kSeen = 0.015;        // change of some signal's error energy, noise included, that one sees
// ... or of the whitened: a coarse encoder hides from the eye what its count still tells
constexpr double kSeenWhitened = 0.1;
constexpr double kExtrapolationLoss = 0.03;
// ... unless what is left of the held-out energy times the rise is below this: where two effects made up for
// each other, the first one to come in raises the error of the motion that they did so in.
constexpr double kOutweighed = 0.5;

// The largest relative fall of one signal's error energy, as somebody sees it who looks at the signal.
double unweighted_gain(const Eigen::VectorXd& parent, const Eigen::VectorXd& child) {
  double most = 0.0;
  for (Eigen::Index k = 0; k < std::min(parent.size(), child.size()); ++k) {
    if (parent[k] > 0.0) most = std::max(most, 1.0 - child[k] / parent[k]);
  }
  return most;
}

// How much more an addition leaves in a use than its parent, both counted only from where the simulated null
// ends: what measured inputs' noise makes of the slowest part of a residual goes up or down with every refit.
double rise_above_null(const WhitenedResiduals& residuals, const NullModel& null,
                       const Eigen::VectorXd& parent, const Eigen::VectorXd& child) {
  const Eigen::VectorXd level = null.floor(residuals.split()) + null.spread(residuals.split());
  const Eigen::VectorXd before = residuals.mean_square(parent).cwiseMax(level),
                        after = residuals.mean_square(child).cwiseMax(level);
  const Eigen::VectorXd weights = weights_for(residuals, null, parent, child);
  double sum = 0.0;
  for (Eigen::Index k = 0; k < before.size(); ++k) {
    if (before[k] > 0.0) sum += weights[k] * (after[k] / before[k] - 1.0);
  }
  return weights.sum() > 0.0 ? sum / weights.sum() : 0.0;
}

// Of the extrapolation runs; 0 where the bootstrap does not see one, or where nobody would who looks at the
// signals: the slowest part of a residual, whitened, tells of a last digit of a base parameter.
double extrapolation_rise(const AcceptanceContext& context, const Fitted& parent, const Fitted& child,
                          const SplitGain& gain) {
  const WhitenedResiduals& residuals = (*context.splits)[kExtrapolation];
  if (residuals.empty() || gain.best <= 1.0) return 0.0;
  const bool known_as_seen =
      child.unweighted[kExtrapolation].size() > 0 && parent.unweighted[kExtrapolation].size() > 0;
  if (known_as_seen &&
      unweighted_gain(child.unweighted[kExtrapolation], parent.unweighted[kExtrapolation]) < kSeen)
    return 0.0;
  return std::min(gain.ratio - 1.0, rise_above_null(residuals, *context.null, parent.residual[kExtrapolation],
                                                    child.residual[kExtrapolation]));
}

// Why an addition that gains little is believed all the same; empty: it is not.
std::string reason_by_prior(const Fitted& parent, const Fitted& child, const AcceptanceResult& gains,
                            double held_ratio, std::string_view aliased_parameter) {
  const std::string path = restores_prior(parent.fit, child.fit, aliased_parameter);
  if (path.empty() || held_ratio > 1.0 + kMostEnergyRise || gains.fit.ratio > 1.0 + kMostEnergyRise)
    return "";
  const std::string_view which = path == aliased_parameter ? "; these data cannot part the two" : "";
  return fmt::format(
      "{} comes back towards what the model file says ({:.1f} of its tolerances off without it, {:.1f} with "
      "it), "
      "at no more error{}",
      path, prior_deviation(parent.fit, path), prior_deviation(child.fit, path), which);
}

}  // namespace

Fitted fitted(const Splits& splits, const Splits& unweighted, FitResult fit, int jobs) {
  Fitted out{.fit = std::move(fit), .residual = {}, .finite = true};
  for (std::size_t u = 0; u < kSplits; ++u) {
    if (splits[u].empty()) continue;
    out.residual[u] = splits[u].residual(out.fit.model, jobs);
    if (out.residual[u].size() != splits[u].size()) {
      out.finite = false;
      continue;
    }
    const Eigen::VectorXd residual = unweighted[u].residual(out.fit.model, jobs);
    if (residual.size() == unweighted[u].size()) out.unweighted[u] = unweighted[u].mean_square(residual);
  }
  return out;
}

AcceptanceResult test_acceptance(const AcceptanceContext& context, const Fitted& parent, const Fitted& child,
                                 const std::string& name, double signal_to_null,
                                 std::string_view aliased_parameter) {
  AcceptanceResult out;
  if (!child.finite) {
    out.why = "the model with it does not stay finite";
    return out;
  }
  std::array<SplitGain*, kSplits> gains{&out.fit, &out.holdout, &out.extrapolation};
  for (std::size_t u = 0; u < kSplits; ++u) {
    if ((*context.splits)[u].empty()) continue;
    const WhitenedResiduals& residuals = (*context.splits)[u];
    const Eigen::VectorXd weights =
        weights_for(residuals, *context.null, parent.residual[u], child.residual[u]);
    *gains[u] = context.bootstrap[u]->gain(parent.residual[u], child.residual[u], weights);
    gains[u]->floor = floor_share(residuals, *context.null, parent.residual[u], weights);
  }
  const Split decides = (*context.splits)[kValidation].empty() ? Split::kTraining : Split::kValidation;
  const std::size_t d = static_cast<std::size_t>(decides);
  const SplitGain& held = *gains[d];
  const double needed = kMatters + kMattersAtFloor * held.floor;
  out.decisive = 1.0 - held.ratio > kPlain && held.worst < 1.0;
  const double rise = extrapolation_rise(context, parent, child, out.extrapolation);
  std::string against = implausibility(parent.fit, child.fit, name, out.decisive);
  if (against.empty()) against = below_time_resolution(child.fit, name, context.rate_Hz);
  if (signal_to_null < kChanceMargin) {
    out.why = fmt::format("its gain is {:.1f} times what chance gives in the simulated null", signal_to_null);
  } else if (1.0 - out.fit.ratio < 0.5 * kMatters) {
    out.why = fmt::format("it lowers the error energy of the fit runs by {:.1f} % only",
                          100.0 * (1.0 - out.fit.ratio));
  } else if (1.0 - held.ratio < needed) {
    out.why =
        held.ratio > 1.0
            ? fmt::format(
                  "it lowers the error that it was fitted to, and raises the {} error energy by {:.1f} %",
                  decides == Split::kValidation ? "held-out" : "fit", 100.0 * (held.ratio - 1.0))
            : fmt::format("it takes {:.1f} % of the held-out error energy; {:.1f} % would matter",
                          100.0 * (1.0 - held.ratio), 100.0 * needed);
  } else if (const double unweighted = unweighted_gain(parent.unweighted[d], child.unweighted[d]);
             unweighted < kSeen && 1.0 - held.ratio < kSeenWhitened) {
    out.why = fmt::format("no signal's error falls by more than {:.1f} % in energy as it is seen",
                          100.0 * unweighted);
  } else if (held.worst > 1.0) {
    out.why = "its gain comes from a few moments of the held-out runs alone";
  } else if (rise > kExtrapolationLoss && held.ratio * (1.0 + rise) > kOutweighed) {
    out.why = fmt::format("it raises the error energy of the extrapolation runs by {:.0f} %", 100.0 * rise);
  } else if (out.why = against; out.why.empty()) {
    out.accepted = true;
    out.why = fmt::format("held-out error energy falls by {:.1f} %", 100.0 * (1.0 - held.ratio));
  }
  if (out.accepted || rise > kExtrapolationLoss || !against.empty()) return out;
  if (std::string why = reason_by_prior(parent, child, out, held.ratio, aliased_parameter); !why.empty()) {
    out.accepted = out.by_prior = true;
    out.why = std::move(why);
  }
  return out;
}

}  // namespace omnihil
