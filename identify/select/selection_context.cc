#include "identify/select/selection_context.h"

#include <fmt/format.h>

#include "sim/law/effect_registry.h"

namespace omnihil {
namespace {

// Replicates of the null, by cost: a simulation of all runs each. Their largest gain is then a 92 % quantile
// (n / (n + 1)) per effect; a 95 % quantile cannot be resolved. DECISIONS 22; sensitivity not measured.
constexpr int kReplicates = 12;  // by cost
// Iterations of a fit, by cost. Tuned on the open cases; sensitivity not measured.
constexpr int kThoroughIterations = 30;  // by cost
constexpr int kCoarseIterations = 12;    // by cost

// Of the first run that has samples at a rate.
double rate_Hz(const Predictor& predictor) {
  for (int run = 0; run < predictor.run_count(); ++run) {
    const double period_s = median_period_s(predictor.run(run).time_s);
    if (period_s > 0.0) return 1.0 / period_s;
  }
  return 0.0;
}

// Of an axis, or of a robot's first wheel; 0: no encoder.
double counts_per_rotor_turn(const Dataset& dataset, double gear_ratio) {
  for (const std::string_view name : {"encoder", "encoder_1"}) {
    const Channel* encoder = dataset.channel(name);
    if (encoder != nullptr) return encoder->counts_per_rev / (encoder->on_output ? gear_ratio : 1.0);
  }
  return 0.0;
}

}  // namespace

SelectionContext::SelectionContext(const Dataset& dataset, const Candidate& nominal,
                                   const SelectionOptions& options)
    : dataset_(dataset),
      nominal_(nominal),
      options_(options),
      predictor_(make_predictor(dataset, nominal, {})),
      channels_(compared_channels(*predictor_)),
      splits_{WhitenedResiduals(*predictor_, channels_, Split::kTraining),
              WhitenedResiduals(*predictor_, channels_, Split::kValidation),
              WhitenedResiduals(*predictor_, channels_, Split::kExtrapolation)},
      unweighted_{WhitenedResiduals(*predictor_, channels_, Split::kTraining, Weighing::kUnweighted),
                  WhitenedResiduals(*predictor_, channels_, Split::kValidation, Weighing::kUnweighted),
                  WhitenedResiduals(*predictor_, channels_, Split::kExtrapolation, Weighing::kUnweighted)} {}

RefitSetup SelectionContext::setup(bool coarse, const std::function<bool()>& stop) const {
  RefitSetup s;
  s.predictor = predictor_.get();
  s.splits = &splits_;
  s.unweighted = &unweighted_;
  s.nominal = &nominal_;
  s.seed = options_.seed;
  s.jobs = options_.jobs;
  s.coarse = coarse;
  s.max_iterations = coarse ? kCoarseIterations : kThoroughIterations;
  s.stop = stop;
  return s;
}

bool SelectionContext::fit_base(const std::function<bool()>& stop, const Candidate& start) {
  RefitSetup thorough = setup(false, stop);
  thorough.profile = false;
  base_ = refit_to_convergence(thorough, refit_as_it_is(thorough, start, 1));
  if (base_.finite && !stop()) base_ = refit_as_it_is(thorough, base_.fit.model, 1);
  return base_.finite && !splits_[kTraining].empty();
}

void SelectionContext::profile_base(const std::function<bool()>& stop) {
  RefitSetup at_rest = setup(false, stop);
  at_rest.max_iterations = 0;
  Fitted profiled = refit_as_it_is(at_rest, base_.fit.model, 1);
  if (!profiled.finite || profiled.fit.stopped) return;
  profiled.fit.iterations = base_.fit.iterations;
  profiled.fit.converged = base_.fit.converged;
  base_ = std::move(profiled);
}

void SelectionContext::simulate() {
  null_ = simulate_null(*predictor_, base_.fit.model, splits_, options_.seed, kReplicates, options_.jobs);
  bootstrap_.clear();
  for (std::size_t u = 0; u < kSplits; ++u) bootstrap_.emplace_back(splits_[u], options_.seed + u);
}

SelectionTask SelectionContext::task(std::vector<std::string>& not_applicable) const {
  SelectionTask task;
  task.dataset = &dataset_;
  task.predictor = predictor_.get();
  task.nominal = &nominal_;
  task.channels = &channels_;
  task.splits = &splits_;
  task.unweighted = &unweighted_;
  task.null = &null_;
  task.acceptance_context = {
      .splits = &splits_,
      .null = &null_,
      .channels = &channels_,
      .bootstrap = {&bootstrap_[kTraining], &bootstrap_[kValidation], &bootstrap_[kExtrapolation]},
      .resolution = {.rate_Hz = rate_Hz(*predictor_),
                     .loop_period_s = predictor_->capabilities().loop_period_s,
                     .counts_per_rotor_turn = counts_per_rotor_turn(dataset_, drive_of(nominal_).gear_ratio)},
      .base = &base_.residual,
      .base_fit = &base_.fit};
  for (std::size_t u = 0; u < kSplits; ++u)
    task.acceptance_context.signal_variance[u] = unweighted_[u].measured_variance();
  task.seed = options_.seed;
  task.jobs = options_.jobs;
  for (const EffectEntry* e : all_effects()) {
    if (is_formula(*e->info)) continue;  // user formulas, and unknown structure
    const std::string why_not = predictor_->applies(*e);
    if (why_not.empty()) {
      task.applicable.push_back(e);
    } else {
      not_applicable.push_back(fmt::format("{}: {}", e->info->id, why_not));
    }
  }
  return task;
}

}  // namespace omnihil
