#include "identify/select/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

// Smallest excess over the null's energy that counts as structure. Tuned on the open cases (DECISIONS 35);
// sensitivity not measured.
constexpr double kStructure = 0.10;  // tuned
// Fraction of the baseline's excess that an accepted effect may leave. Right laws in another form left 4 % at
// most in 67 cases of the hidden-effect test, wrong ones passed where 20 % was allowed (DECISIONS 46).
constexpr double kUnexplained = 0.10;  // tuned
// Standard deviations of the null's replicates: far out, since that standard deviation comes from few
// replicates (8: known to 27 %, 1 / sqrt(2 (n - 1))). Tuned on the open cases; sensitivity not measured.
constexpr double kSpreads = 5.0;  // tuned

// Of the null's energy: 2.5 standard deviations where a torque's noise is known worst (axis_inverse.cc); derived.
constexpr double kTooFarBelow = 0.5;  // derived

// The channel as the first run that has it compares it; null: none does.
const ComparedSignal* signal_of(const Predictor& predictor, const std::string& channel) {
  for (int run = 0; run < predictor.run_count(); ++run) {
    for (const ComparedSignal& s : predictor.compared(run)) {
      if (s.name == channel) return &s;
    }
  }
  return nullptr;
}

// "2.1 rad/s RMS of velocity on held-out runs, 9 times the sensors' noise"
std::string remainder(const ResidualExcess& excess) {
  constexpr double kAtNoise =
      1.05;  // of its root mean square: the replicates' own scatter is of that order; a choice
  const double ratio = std::sqrt(std::max(0.0, 1.0 + excess.excess));
  const std::string_view runs = excess.split == Split::kTraining     ? "fit"
                                : excess.split == Split::kValidation ? "held-out"
                                                                     : "extrapolation";
  return fmt::format(
      "{:.3g} {} RMS of {} on {} runs, {}", excess.rms, excess.unit, excess.signal, runs,
      excess.excess < -kTooFarBelow
          ? fmt::format("{:.2g} times the noise that the sensors were taken to have: too much (state "
                        "its `sigma`), and what is smaller was not looked for",
                        ratio)
      : ratio < kAtNoise ? "as the sensors' noise alone would leave"
      : excess.noise_level_sigma > 0.0
          ? fmt::format("{:.3g} times the sensors' noise, which is known to {:.0f} %", ratio,
                        50.0 * excess.noise_level_sigma)  // a variance's is twice its root's
          : fmt::format("{:.3g} times the sensors' noise", ratio));
}

// Of an excess on the extrapolation runs that a fit to all runs does not leave.
std::string parameters_sentence(const ResidualExcess& excess) {
  return fmt::format(
      " Other numbers of this model explain what these do not, {}: the fit runs do not tell them; let a run "
      "of that kind be one.",
      remainder(excess));
}

}  // namespace

Eigen::VectorXd excess_of(const WhitenedResiduals& residuals, const NullModel& null,
                          const ComparedChannels& channels, const Eigen::VectorXd& residual) {
  const Eigen::VectorXd floor = null.floor(residuals.split()), square = residuals.mean_square(residual);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(square.size());
  for (Eigen::Index k = 0; k < out.size(); ++k) {
    if (channels.name[static_cast<std::size_t>(k)] == "bus_voltage") {
      out[k] = -1.0;
    } else if (floor[k] > 0.0) {
      out[k] = square[k] / floor[k] - 1.0;
    }
  }
  return out;
}

ResidualExcesses::ResidualExcesses(const SelectionContext& context, const Candidate& baseline,
                                   Candidate model, std::uint64_t seed, int jobs)
    : context_(context), baseline_(baseline), model_(std::move(model)), jobs_(jobs) {
  constexpr int kReplicates = 8;  // by cost: a simulation of all runs each
  null_ = simulate_null(context.predictor(), model_, context.unweighted(), seed, kReplicates, jobs);
}

ResidualExcess ResidualExcesses::alike() const {
  return on(context_.unweighted()[kValidation].empty() ? kTraining : kValidation);
}

ResidualExcess ResidualExcesses::fitted() const { return on(kTraining); }

ResidualExcess ResidualExcesses::another() const { return on(kExtrapolation); }

ResidualExcess ResidualExcesses::on(Split split) const {
  const WhitenedResiduals& residuals = context_.unweighted()[split];
  const ComparedChannels& channels = context_.channels();
  ResidualExcess out;
  out.split = split;
  if (residuals.empty()) return out;
  const Eigen::VectorXd first = residuals.residual(baseline_, jobs_), now = residuals.residual(model_, jobs_);
  if (first.size() == 0 || now.size() == 0) return out;
  const Eigen::VectorXd before = excess_of(residuals, null_, channels, first);
  const Eigen::VectorXd after = excess_of(residuals, null_, channels, now);
  Eigen::Index worst = 0;
  // Where nothing is left, it is said of what there was something to explain of, not of an input (a measured bus).
  if (after.maxCoeff(&worst) < kStructure && before.maxCoeff() >= kStructure)
    (before.array() >= kStructure).select(after, after.minCoeff() - 1.0).maxCoeff(&worst);
  out.excess = after[worst];
  out.excess_before = before[worst];
  out.signal = channels.name[static_cast<std::size_t>(worst)];
  out.rms = std::sqrt(residuals.mean_square(now)[worst]);
  const double floor = null_.floor(split)[worst];
  out.spread = floor > 0.0 ? null_.spread(split)[worst] / floor : 0.0;
  if (const ComparedSignal* const signal = signal_of(context_.predictor(), out.signal); signal != nullptr) {
    out.unit = signal->unit;
    out.noise_level_sigma = signal->noise_level_sigma;
    out.spread = std::hypot(out.spread, signal->noise_level_sigma);
  }
  double remaining = 0.0, all = 0.0;
  for (Eigen::Index k = 0; k < after.size(); ++k) {
    if (before[k] <= 0.0) continue;
    const double weight = before[k] / (1.0 + before[k]);  // a channel at its noise has nothing to explain
    remaining += weight * std::clamp(after[k] / before[k], 0.0, 1.0);
    all += weight;
  }
  out.unexplained = all > 0.0 ? remaining / all : 0.0;
  return out;
}

Candidate fitted_to_all_runs(const Dataset& dataset, const RefitSetup& setup, const Candidate& model) {
  Dataset all = dataset;
  for (Run& run : all.runs) {
    if (run.split == kExtrapolation) run.split = kTraining;
  }
  const std::unique_ptr<Predictor> predictor = make_predictor(all, *setup.nominal, {});
  return fit(*predictor, model, unknowns_with_priors(model, *setup.nominal),
             {.jobs = setup.jobs,
              .max_iterations = setup.max_iterations,
              .seed = setup.seed,
              .stop = setup.stop})
      .model;
}

bool structure_remains(const ResidualExcess& excess, bool effects_added) {
  const bool above_chance = excess.excess > kSpreads * excess.spread;
  if (!above_chance || excess.excess < kStructure) return false;
  return !effects_added || excess.unexplained > kUnexplained;
}

bool structure_in(const WhitenedResiduals& residuals, const NullModel& null, const ComparedChannels& channels,
                  const Eigen::VectorXd& residual) {
  if (residuals.empty() || residual.size() != residuals.size()) return false;
  const Eigen::VectorXd excess = excess_of(residuals, null, channels, residual);
  const Eigen::VectorXd floor = null.floor(residuals.split()), spread = null.spread(residuals.split());
  for (Eigen::Index k = 0; k < excess.size(); ++k) {
    if (excess[k] >= kStructure && excess[k] * floor[k] > kSpreads * spread[k]) return true;
  }
  return false;
}

std::string too_noisy(const ResidualExcess& excess) {
  if (excess.excess >= -kTooFarBelow) return "";
  return fmt::format("with the noise that it makes {} would be {:.2g} times as noisy as it is", excess.signal,
                     1.0 / std::sqrt(std::max(1.0 + excess.excess, 1e-6)));
}

std::string residual_sentence(const ResidualExcess& excess, bool effects_added) {
  const std::string left = remainder(excess);
  if (structure_remains(excess, effects_added)) {
    const std::string_view elsewhere =
        excess.split == Split::kExtrapolation
            ? " The fit runs, by which effects are found, do not show it: let a run of that kind be one."
            : "";
    if (!effects_added)
      return fmt::format("Structure remains that no known effect explains: {}.{}", left, elsewhere);
    return fmt::format(
        "More remains that no known effect explains: {}; {:.0f} % of what the base model left.{}", left,
        100.0 * excess.unexplained, elsewhere);
  }
  if (!effects_added)
    return fmt::format("Nothing that matters is missing as far as these data show: {}.", left);
  // An effect accepted for a prior need not explain any energy.
  const std::string explained = excess.excess_before < kStructure
                                    ? ""
                                    : fmt::format("; {:.0f} % of what the base model left is explained",
                                                  100.0 * (1.0 - excess.unexplained));
  return fmt::format("What is left: {}{}.", left, explained);
}

Remaining remaining(const ResidualExcesses& excesses, const ResidualExcess& alike, bool effects_added,
                    const std::function<ResidualExcess()>& another_of_all) {
  const auto remains = [&](const ResidualExcess& e) { return structure_remains(e, effects_added); };
  Remaining out{.excess = alike, .of_parameters = ""};
  if (remains(out.excess)) return out;
  if (const ResidualExcess fitted = excesses.fitted(); remains(fitted)) {
    out.excess = fitted;
  } else if (const ResidualExcess another = excesses.another(); remains(another)) {
    if (remains(another_of_all())) {
      out.excess = another;
    } else {
      out.of_parameters = parameters_sentence(another);
    }
  }
  return out;
}

std::string sentence_of(const Remaining& left, bool effects_added) {
  return residual_sentence(left.excess, effects_added) + left.of_parameters;
}

Outcome outcome_of(bool searched, bool effects_added, bool remains) {
  if (!searched) return Outcome::kNotSearched;
  if (!effects_added) return Outcome::kNothingFound;
  return remains ? Outcome::kMoreRemains : Outcome::kFound;
}

}  // namespace omnihil
