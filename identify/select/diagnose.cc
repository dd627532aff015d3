#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "identify/record/parallel.h"
#include "identify/select/confidence.h"
#include "identify/select/diagnose_summary.h"
#include "identify/select/diagnosis.h"
#include "identify/select/effect_variants.h"
#include "identify/select/elimination.h"
#include "identify/select/innovations.h"
#include "identify/select/nested_law.h"
#include "identify/select/next_experiment.h"
#include "identify/select/noise_effect.h"
#include "identify/select/plausibility.h"
#include "identify/select/selection_context.h"
#include "identify/select/selection_pair.h"
#include "identify/select/unknown_structure.h"
#include "identify/select/verdict.h"

namespace omnihil {
namespace {

// For the progress shown: shares of the work, in order; the iterations take what is between. Guesses.
constexpr double kAfterBaseline = 0.12;  // a guess
constexpr double kAfterNull = 0.16;      // a guess
constexpr double kAfterRounds = 0.85;    // a guess
// Fall of the energy at which the parent's fit counts as not converged: two thirds of the smallest gain of interest.
// Restarts for that, by cost. Tuned on the open cases; sensitivity not measured.
constexpr double kNotConverged = 0.02;  // tuned
constexpr int kMostRestarts = 2;        // by cost

constexpr const char* kBaseStep = "base parameters refitted";

class Diagnosing {
 public:
  // recorded: what was measured; heard: the same as it is compared.
  Diagnosing(const Dataset& recorded, HeardCommands heard, const Candidate& nominal,
             const DiagnoseOptions& options)
      : recorded_(recorded), nominal_(nominal), options_(options), data_(data_of(std::move(heard))) {
    out_.dataset = recorded.name;
    out_.seed = options.seed;
    out_.outcome = Outcome::kNotSearched;  // until it is
    out_.not_searched = kInterrupted;
  }

  Diagnosis run() {
    out_.findings = check_data(recorded_, nominal_);
    out_.nominal_comparison = compare(context().predictor(), nominal_);
    add_step("nominal", {}, out_.nominal_comparison);
    if (!baseline()) return finish_early();
    simulate();
    if (stopped_) return finish_early();
    if (!misleading()) {
      iterate();
      eliminate();
      search_anew();
      split_rich_laws();
      simplify();
      hear_anew();
    }
    conclude();
    return std::move(out_);
  }
  const HeardCommands& heard() const { return data_->heard; }

 private:
  // What was heard, and what all iterations make of it.
  struct Data {
    HeardCommands heard;
    SelectionContext context;

    Data(HeardCommands of, const Candidate& nominal, const SelectionOptions& options)
        : heard(std::move(of)), context(heard.dataset, nominal, options) {}
  };
  std::unique_ptr<Data> data_of(HeardCommands heard) const {
    return std::make_unique<Data>(std::move(heard), nominal_,
                                  SelectionOptions{.seed = options_.seed, .jobs = options_.jobs});
  }
  SelectionContext& context() const { return data_->context; }

  bool say(const std::string& doing, double share) {
    const std::scoped_lock lock(mutex_);
    furthest_ = std::max(furthest_, share);
    if (options_.progress && !options_.progress({.doing = doing, .share = furthest_})) stopped_ = true;
    return !stopped_;
  }

  // Base parameters before anything else: their tolerances are priors.
  bool baseline() {
    if (!say("refitting the base parameters", 0.02)) return false;
    const bool usable = context().fit_base(stop());
    if (!usable && !stopped_) {
      out_.not_searched =
          "the base parameters cannot be fitted: the model does not stay finite, or there are no fit runs";
    }
    out_.baseline = context().base().fit;
    out_.baseline_comparison = compare(context().predictor(), context().base().fit.model);
    add_step(kBaseStep, context().base(), out_.baseline_comparison);
    current_ = context().base();
    return say("base parameters refitted", kAfterBaseline) && usable;
  }

  void simulate() {
    context().simulate();
    not_applicable_.clear();
    task_ = context().task(not_applicable_);
    out_.not_visible = not_applicable_;
    say("simulated null", kAfterNull);
  }

  std::function<bool()> stop() {
    return [this] {
      if (options_.stop && options_.stop()) stopped_ = true;
      return stopped_.load();
    };
  }

  // A fault of the data that would be taken for physics.
  bool misleading() const { return !options_.despite_faults && first_fault(out_.findings) != nullptr; }

  void iterate() {
    double from = kAfterNull;
    int restarts = 0;
    std::optional<Iteration> again;  // of this round, beside a better parent
    for (int n = 0; n < options_.max_effects && !stopped_; ++n) {
      const double to = from + 0.5 * (kAfterRounds - from);
      task_.progress = [&](const std::string& doing, double share) {
        return say(fmt::format("round {}: {}", n + 1, doing), from + share * (to - from));
      };
      const bool is_again = again.has_value();
      Iteration iteration = is_again ? std::move(*again) : selection_iteration(task_, current_);
      again.reset();
      const bool first = out_.effects.empty() && n == 0;
      if (first) first_ranking(iteration);
      if (n == 0 || !iteration.orders.empty())
        order_ = iteration.orders.empty() ? 0.0 : iteration.orders.front();
      // The refit may find better base parameters for the parent itself: what came near the best is ranked again from there.
      if (iteration.chosen >= 0 && parent_not_converged(iteration) && ++restarts <= kMostRestarts) {
        again = near_best_again(task_, current_, iteration);
        --n;
        continue;
      }
      std::optional<Fitted> converged = converged_choice(iteration);
      if (!converged && is_again && !iteration.stopped) {  // none of those: all of them
        --n;
        continue;
      }
      if (!converged && !iteration.stopped) converged = by_innovations(iteration);
      const bool unexplained = !converged && !iteration.stopped && pairs_asked() && worth_another_iteration();
      if (unexplained) converged = converged_choice(with_small_gains(iteration));
      if (first) out_.ranking = iteration.ranking;
      out_.ladder.back().ranking = iteration.ranking;
      if (!converged) {
        if (!unexplained || !take_pair(iteration)) return;
        from = to;
        continue;
      }
      take(iteration, std::move(*converged));
      if (!worth_another_iteration()) return;
      from = to;
    }
  }

  // Nothing was accepted by the plain residual.
  std::optional<Fitted> by_innovations(Iteration& iteration) {
    std::optional<InnovationChoice> choice =
        choice_by_innovations(task_, context().setup(true, stop()), current_, iteration);
    if (!choice) return std::nullopt;
    iteration = std::move(choice->iteration);
    by_innovations_.push_back(iteration.candidates[static_cast<std::size_t>(iteration.chosen)].screened.name);
    return std::move(choice->fitted);
  }

  // Structure remains, and nothing was accepted.
  Iteration& with_small_gains(Iteration& iteration) {
    task_.acceptance_context.structure_remains = true;
    judge_anew(task_, current_, iteration);
    return iteration;
  }

  // Where nothing has been found at all, an answer is worth two further iterations.
  bool pairs_asked() const { return options_.pairs || (out_.effects.empty() && options_.max_effects > 1); }

  // Did the parent's fit stop short? Then part of the effect's gain belongs to the base parameters.
  bool parent_not_converged(const Iteration& iteration) {
    const CandidateEffect& best = iteration.candidates[static_cast<std::size_t>(iteration.chosen)];
    if (best.screened.extends) return false;
    Fitted without = refit_as_it_is(context().setup(true, stop()),
                                    without_effect(best.fitted.fit.model, best.screened.name), 1);
    if (!without.finite) return false;
    const double ratio = energy_ratio(context().splits()[kTraining], current_.residual[kTraining],
                                      without.residual[kTraining]);
    if (ratio > 1.0 - kNotConverged) return false;
    current_ = std::move(without);
    if (out_.effects.empty()) rebase();
    return true;
  }

  // The baseline itself had not converged: replace it in the answer.
  void rebase() {
    context().take_base(current_);
    out_.baseline = current_.fit;
    out_.baseline_comparison = compare(context().predictor(), current_.fit.model);
    out_.ladder.back().comparison = out_.baseline_comparison;
    out_.ladder.back().parameters = current_.fit.parameters;
  }

  void first_ranking(const Iteration& iteration) {
    out_.ranking = iteration.ranking;
    out_.not_visible = not_applicable_;
    for (const RankedEffect& r : iteration.ranking) {
      if (r.visibility != Visibility::kVisible) out_.not_visible.push_back(r.effect + ": " + r.why);
    }
    if (!iteration.stopped && !iteration.ranking.empty())
      say("first ranking: " + iteration.ranking.front().effect, kAfterNull);
  }

  // The best candidate, fitted to convergence: the shortlist's refits are coarse, and the energy that they did not
  // remove would be the next iteration's structure. A candidate whose parameters go to a bound on that way imitates
  // something else, and the next one is looked at.
  std::optional<Fitted> converged_choice(Iteration& iteration) {
    while (iteration.chosen >= 0) {
      const CandidateEffect& best = iteration.candidates[static_cast<std::size_t>(iteration.chosen)];
      Fitted fitted = refit_to_convergence(context().setup(true, stop()), best.fitted);
      std::string why = ends_at_bound(fitted.fit, best.screened.name);
      if (why.empty() && (best.screened.entry->info->claims & kRandom) != 0)
        why = too_noisy(excesses_of(fitted.fit.model).alike());
      if (why.empty() || stopped_) return fitted;
      refuse_chosen(task_, current_, why, iteration);
    }
    return std::nullopt;
  }

  void take(const Iteration& iteration, Fitted converged) {
    const CandidateEffect& best = iteration.candidates[static_cast<std::size_t>(iteration.chosen)];
    current_ = std::move(converged);
    if (!best.screened.extends) {
      out_.effects.push_back(best.screened.name);
      aliased_parameter_[best.screened.name] = best.screened.aliased_parameter();
    }
    add_step(best.screened.name, current_);
    note_confounded(iteration, out_);
  }

  // No single effect is accepted, and structure remains: two that mask each other may be.
  bool take_pair(const Iteration& singles) {
    const EffectPair pair = selection_pair(task_, current_, singles);
    if (!pair.found()) return false;
    current_ = refit_to_convergence(context().setup(true, stop()), pair.fitted);
    pair_ = pair.names;
    for (std::size_t k = 0; k < pair.names.size(); ++k) {
      out_.effects.push_back(pair.names[k]);
      aliased_parameter_[pair.names[k]] = pair.aliased_parameters[k];
    }
    add_step(fmt::format("{}", fmt::join(pair.names, " and ")), current_);
    return true;
  }

  void eliminate() {
    bool removed = false;
    while (!out_.effects.empty() && !stopped_) {
      say("are all effects still needed", kAfterRounds);
      std::optional<UnneededEffect> unneeded =
          unneeded_effect(task_, context().setup(true, stop()), current_, found(), removed);
      if (!unneeded) return;
      current_ = std::move(unneeded->fitted);
      std::erase(out_.effects, unneeded->name);
      add_step("removed " + unneeded->name, current_);
      removed = true;
    }
  }
  // Nothing is left of what was found, but on that way the base parameters came to a better fit: the search began beside a local
  // optimum, and what it refused was measured against that.
  void search_anew() {
    if (!out_.effects.empty() || stopped_) return;
    const double ratio = energy_ratio(context().splits()[kTraining], context().base().residual[kTraining],
                                      current_.residual[kTraining]);
    if (ratio > 1.0 - kNotConverged) return;
    out_.ladder.erase(out_.ladder.begin() + 2, out_.ladder.end());  // nominal, base parameters refitted
    rebase();
    simulate();
    pair_.clear(), by_innovations_.clear(), aliased_parameter_.clear();
    iterate();
    eliminate();
  }
  EffectsFound found() const { return {out_.effects, aliased_parameter_, pair_, by_innovations_}; }

  // A law whose shapes imitate another one leaves that too little to be accepted. Asked where the bootstrap selects what was refused.
  void split_rich_laws() {
    const std::vector<RankedEffect>& last = out_.ladder.back().ranking;
    if (last.empty() || last.front().selection_frequency <= 0.5) return;
    const std::string other = last.front().effect;
    for (const std::string& name : std::vector<std::string>(out_.effects)) {
      if (stopped_) return;
      std::optional<SplitLaw> split = split_law(task_, context().setup(true, stop()), current_, name, other);
      if (!split) continue;
      std::ranges::replace(out_.effects, name, split->simpler);
      add_replacement(split->simpler, name, split->with_simpler);
      out_.ladder.back().ranking = split->iteration.ranking;
      take(split->iteration, std::move(split->fitted));
      if (worth_another_iteration()) iterate();
      eliminate();
    }
  }

  // Laws whose shapes imitated what later effects explain give way to the laws that they become at a limit.
  void simplify() {
    for (std::size_t n = 0; n < out_.effects.size() && !stopped_; ++n) {
      const std::string name = out_.effects[n];
      if (std::ranges::find(by_innovations_, name) != by_innovations_.end()) continue;
      std::optional<NestedLaw> simpler = nested_law(task_, context().setup(true, stop()), current_, name);
      if (!simpler) continue;
      current_ = std::move(simpler->fitted);
      replace_in_answer(name, simpler->name, out_);
      add_replacement(simpler->name, name, current_);
    }
  }

  // Which commands were lost was decided by a model without the effects that it has now: once more with them, and all
  // figures by what was heard then.
  void hear_anew() {
    if (out_.effects.empty() || stopped_) return;
    say("are the same commands lost", kAfterRounds);
    HeardCommands anew = heard_by(recorded_, nominal_, current_.fit.model);
    if (anew.same_lost(heard())) return;
    std::unique_ptr<Data> data = data_of(std::move(anew));
    if (!data->context.fit_base(stop(), context().base().fit.model) || stopped_) return;
    data->context.simulate();
    data_ = std::move(data);
    std::vector<std::string> known;
    const bool remained = task_.acceptance_context.structure_remains;
    task_ = context().task(known);
    task_.acceptance_context.structure_remains = remained;
    out_.nominal_comparison = compare(context().predictor(), nominal_);
    out_.baseline = context().base().fit;
    out_.baseline_comparison = compare(context().predictor(), out_.baseline.model);
    const RefitSetup setup = context().setup(true, stop());  // as each choice was; the last fit is thorough
    current_ = refit_to_convergence(setup, refit_as_it_is(setup, current_.fit.model, 1));
    heard_anew_ = true;
    add_step("lost commands decided anew", current_);
  }

  // Of the base parameters that the answer has: until then better ones may come.
  void give_intervals() {
    say("intervals of the base parameters", 0.87);
    if (stopped_) return;
    const bool is_base = out_.effects.empty() && current_.fit.cost == context().base().fit.cost;
    context().profile_base(stop());
    out_.baseline = context().base().fit;
    if (is_base) current_ = context().base();
    for (LadderStep& step : out_.ladder)
      if (step.added == kBaseStep && !heard_anew_) step.parameters = out_.baseline.parameters;
  }

  void conclude() {
    give_intervals();
    say("last fit", 0.88);
    bool added = !out_.effects.empty();
    std::optional<Fitted> last = added && !stopped_
                                     ? last_fit(task_, context().setup(false, stop()), current_, found())
                                     : std::nullopt;
    if (last) {
      current_ = std::move(*last);
      out_.ladder.back().comparison = compare(context().predictor(), current_.fit.model);
      out_.ladder.back().parameters = current_.fit.parameters;
    }
    std::optional<ResidualExcesses> excesses(excesses_of(current_.fit.model));
    ResidualExcess alike = excesses->alike();
    if (!misleading() && !stopped_ && structure_remains(alike, false) && take_noise_effect()) {
      excesses.emplace(excesses_of(current_.fit.model));
      alike = excesses->alike();
    }
    added = !out_.effects.empty();
    out_.final_fit = current_.fit;
    out_.final_comparison =
        added ? compare(context().predictor(), current_.fit.model) : out_.baseline_comparison;
    out_.not_searched = reason_not_searched(out_, misleading(), stopped_);
    const bool searched = out_.not_searched.empty();
    if (const DataFinding* fault = first_fault(out_.findings); fault != nullptr && searched)
      out_.searched_despite = fault->sentence;
    const bool look_further = !misleading() && !stopped_;
    const Remaining left = look_further
                               ? remaining(*excesses, alike, added, [&] { return fitted_to_all().another(); })
                               : Remaining{.excess = alike, .of_parameters = ""};
    const bool remains = !searched || structure_remains(left.excess, added);
    out_.verdict = remains ? Verdict::kUnknown : (added ? Verdict::kEffect : Verdict::kAdequate);
    out_.where = where_of(added && !remains ? out_.baseline_comparison : out_.final_comparison, order_);
    out_.outcome = outcome_of(searched, added, remains);
    if (remains && searched && !stopped_) {
      say("looking for a formula", 0.92);
      out_.unknown = unknown_structure(task_, current_, out_.final_comparison, stop());
    }
    out_.unknown.sentence = !searched             ? "No effect was tried: " + out_.not_searched
                            : stopped_ && remains ? kSearchInterrupted
                                                  : sentence_of(left, added);
    settle_confounded(heard().dataset, out_);
    out_.confidence = confidences(out_);
    out_.next_experiment = next_experiment(heard().dataset, out_);
    out_.complete = !stopped_;
    say("done", 1.0);
  }

  ResidualExcesses excesses_of(const Candidate& model) const {
    return {context(), out_.baseline.model, model, options_.seed, options_.jobs};
  }
  ResidualExcesses fitted_to_all() {
    return excesses_of(
        fitted_to_all_runs(heard().dataset, context().setup(false, stop()), current_.fit.model));
  }

  // Stop when the residual is at the null level (DECISIONS 35), unless a base parameter is prior-implausible
  // (DECISIONS 50).
  bool worth_another_iteration() {
    const std::size_t u = context().splits()[kValidation].empty() ? kTraining : kValidation;
    return is_implausible(current_.fit) ||
           structure_in(context().splits()[u], context().null(), context().channels(),
                        current_.residual[u]) ||
           structure_remains(excesses_of(current_.fit.model).alike(), false);  // no allowance for a form
  }

  // The remaining variance may be noise that an effect makes. Its strength is estimated from variances, not
  // by the fit, which sees the mean.
  bool take_noise_effect() {
    say("noise effects", 0.9);
    std::vector<const EffectEntry*> others = task_.applicable;
    std::erase_if(others, [&](const EffectEntry* e) {
      return std::ranges::find(out_.effects, e->info->id) != out_.effects.end();
    });
    const std::optional<NoiseEffect> found = noise_effect({.predictor = &context().predictor(),
                                                           .unweighted = &context().unweighted(),
                                                           .model = &current_.fit.model,
                                                           .seed = options_.seed},
                                                          others);
    if (!found) return false;
    const std::string name(found->use.entry->info->id);
    current_.fit.model = with_use(current_.fit.model, found->use);
    current_.fit.parameters.push_back(found->strength);
    out_.effects.push_back(name);
    add_step(name, current_);
    note_noise_effect(name, found->explained, parameters_of(current_.fit, name), out_);
    return true;
  }

  Diagnosis finish_early() {
    out_.complete = false;
    out_.final_fit = out_.baseline;
    out_.final_comparison = out_.baseline_comparison;
    return std::move(out_);
  }

  void add_replacement(const std::string& simpler, const std::string& richer, const Fitted& model) {
    add_step(fmt::format("{} in place of {}", simpler, richer), model);
  }
  void add_step(const std::string& added, const Fitted& model) {
    add_step(added, model, compare(context().predictor(), model.fit.model));
  }
  void add_step(const std::string& added, const Fitted& model, const Comparison& comparison) {
    out_.ladder.push_back(
        {.added = added, .comparison = comparison, .parameters = model.fit.parameters, .ranking = {}});
  }

  const Dataset& recorded_;
  const Candidate& nominal_;
  const DiagnoseOptions& options_;
  std::unique_ptr<Data> data_;
  SelectionTask task_;
  std::vector<std::string> not_applicable_;
  Fitted current_;
  Diagnosis out_;
  std::map<std::string, std::string> aliased_parameter_;  // of the effects added
  std::vector<std::string> pair_;                         // accepted only together
  std::vector<std::string> by_innovations_;               // accepted only by those
  bool heard_anew_ = false;  // the ladder's first steps are of what was heard before
  double order_ = 0.0;       // strongest of the residual's, per rotor turn
  double furthest_ = 0.0;
  std::mutex mutex_;  // progress comes from several threads
  std::atomic<bool> stopped_{false};
};

}  // namespace

Diagnosis diagnose(const Dataset& dataset, const Candidate& nominal, const DiagnoseOptions& options) {
  const ThreadTeam team(options.jobs);
  Diagnosing diagnosing(dataset,
                        heard_commands(dataset, nominal, {.jobs = options.jobs, .stop = options.stop}),
                        nominal, options);
  Diagnosis out = diagnosing.run();
  for (DataFinding& finding : lost_commands(diagnosing.heard())) out.findings.push_back(std::move(finding));
  return out;
}

}  // namespace omnihil
