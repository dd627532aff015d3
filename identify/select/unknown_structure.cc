#include "identify/select/unknown_structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/compare/order_spectrum.h"
#include "identify/estimate/linear_base.h"
#include "identify/record/parallel.h"
#include "identify/record/rig.h"
#include "identify/record/statistics.h"
#include "identify/select/diagnose_summary.h"
#include "identify/select/unknown_terms.h"
#include "sim/law/effect_registry.h"
#include "sim/law/expression.h"

namespace omnihil {
namespace {

// Terms of a formula, so that it can be read. Least gain of a term, of the residual's energy and over the
// null's largest: above the acceptance test's 2, since the best of many terms is taken. Tuned on the open
// cases; sensitivity not measured. Curves in the report: a screenful.
constexpr std::size_t kMostTerms = 4;       // tuned
constexpr double kLeastGain = 0.02;         // tuned
constexpr double kLeastSignalToNull = 3.0;  // tuned
constexpr std::size_t kMostCurves = 8;      // tuned

struct Library {
  std::string adds_to;
  std::vector<UnknownTerm> terms;
  std::vector<ProjectedColumns> signals;  // one column each; empty: the model diverged
};

// The signal of one term, at a size at which it is comparable with the residual: a tenth where the model
// diverges, by its root mean square where it has more than ten times the residual's energy. Guesses; the
// coefficient is fitted after.
ProjectedColumns signal_of(const SelectionTask& task, const Fitted& last, const LinearBase& base,
                           const std::string& adds_to, UnknownTerm& term) {
  const WhitenedResiduals& fit = (*task.splits)[kTraining];
  constexpr int kAttempts = 3;  // each at a tenth of the size before; by cost
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const EffectUse use = formula_use("residual", adds_to, {term}, {term.size}, last.fit.model.file.linear);
    if (use.entry == nullptr) return {};
    const Eigen::VectorXd with = fit.predicted(with_use(last.fit.model, use));
    if (with.size() != fit.size()) {
      term.size *= 0.1;
      continue;
    }
    const Eigen::VectorXd d = (with - base.prediction()).cwiseProduct(base.weights());
    const double ratio = d.squaredNorm() / std::max(base.energy(), 1e-300);
    if (ratio > 10.0 && attempt + 1 < kAttempts) {
      term.size *= 1.0 / std::sqrt(ratio);
      continue;
    }
    return base.project(d);
  }
  return {};
}

Library library_of(const SelectionTask& task, const Fitted& last, const LinearBase& base, std::string adds_to,
                   std::vector<UnknownTerm> terms) {
  Library library{.adds_to = std::move(adds_to), .terms = std::move(terms), .signals = {}};
  library.signals.resize(library.terms.size());
  parallel_for(task.jobs, static_cast<int>(library.terms.size()), [&](int k) {
    const std::size_t t = static_cast<std::size_t>(k);
    library.signals[t] = signal_of(task, last, base, library.adds_to, library.terms[t]);
  });
  return library;
}

ProjectedColumns joined(const Library& library, const std::vector<std::size_t>& chosen,
                        const LinearBase& base) {
  ProjectedColumns out;
  const Eigen::Index rows = base.residual().size();
  out.columns.resize(rows, static_cast<Eigen::Index>(chosen.size()));
  out.coupling.resize(library.signals[chosen.front()].coupling.rows(), out.columns.cols());
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    out.columns.col(static_cast<Eigen::Index>(c)) = library.signals[chosen[c]].columns.col(0);
    out.coupling.col(static_cast<Eigen::Index>(c)) = library.signals[chosen[c]].coupling.col(0);
  }
  out.gram = out.columns.transpose() * out.columns;
  return out;
}

struct Selection {
  std::vector<std::size_t> chosen;
  LinearGain fit;  // coefficients: multiples of the terms' sizes
};

// Adds the term of largest gain; false: none gains enough.
bool add_best(const Library& library, const LinearBase& base, const std::vector<Eigen::VectorXd>& noise,
              Selection& selection) {
  double best = selection.fit.gain, null_gain = 0.0;
  std::size_t which = library.terms.size();
  LinearGain found;
  for (std::size_t t = 0; t < library.terms.size(); ++t) {
    constexpr double kRounding = 1e-6;  // residual fraction of a term that the base parameters span; a choice
    const bool usable = library.signals[t].columns.cols() == 1 && library.signals[t].kept > kRounding;
    if (!usable || std::find(selection.chosen.begin(), selection.chosen.end(), t) != selection.chosen.end())
      continue;
    std::vector<std::size_t> chosen = selection.chosen;
    chosen.push_back(t);
    const ProjectedColumns columns = joined(library, chosen, base);
    const std::vector<bool> free(chosen.size(), true);
    for (const Eigen::VectorXd& n : noise) {
      null_gain = std::max(null_gain, base.gain_in_noise(library.signals[t], {true}, n));
    }
    LinearGain gain = base.gain(columns, free);
    if (gain.gain <= best) continue;
    best = gain.gain;
    which = t;
    found = std::move(gain);
  }
  const double added = best - selection.fit.gain;
  if (which == library.terms.size() || added < kLeastGain * base.energy() ||
      added < kLeastSignalToNull * null_gain)
    return false;
  selection.chosen.push_back(which);
  selection.fit = std::move(found);
  return true;
}

// A torque of visible size, N m (N): 2 % of the stall torque, else of the largest one recorded. A guess: the
// size of the first simulation, the coefficient is fitted after.
double torque_scale(const SelectionTask& task, const Candidate& model) {
  const DriveParams<double> d = drive_of(model);
  if (d.resistance_ohm > 0.0 && d.supply_voltage_V > 0.0) {
    return 0.02 * d.torque_constant_Nm_per_A * d.supply_voltage_V / d.resistance_ohm;
  }
  double most = 0.0;
  for (const Run& run : task.dataset->runs) {
    for (const char* name : {"motor_torque", "load_torque"}) {
      const std::vector<double>* torque = run.signal(name);
      if (torque != nullptr) most = std::max(most, largest_size(*torque));
    }
  }
  return most > 0.0 ? 0.02 * most : 0.01;
}

std::vector<RegimeError> telling_curves(const Comparison& comparison) {
  std::vector<RegimeError> curves;
  for (const RegimeError& r : comparison.regimes) {
    if (r.split == Split::kTraining && r.explained_fraction > 0.0) curves.push_back(r);
  }
  std::stable_sort(curves.begin(), curves.end(), [](const RegimeError& a, const RegimeError& b) {
    return a.explained_fraction > b.explained_fraction;
  });
  if (curves.size() > kMostCurves) curves.resize(kMostCurves);
  return curves;
}

// A formula of one place that holds on the held-out runs; gain 0: none.
struct Found {
  EffectUse use;
  double gain = 0.0;
};

Found formula_of(const SelectionTask& task, const Fitted& last, const LinearBase& base,
                 const Library& library, const std::vector<Eigen::VectorXd>& noise,
                 const std::function<bool()>& stop) {
  Selection selection;
  while (selection.chosen.size() < kMostTerms && add_best(library, base, noise, selection)) {
  }
  if (selection.chosen.empty()) return {};
  std::vector<UnknownTerm> terms;
  std::vector<double> coefficients;
  for (std::size_t c = 0; c < selection.chosen.size(); ++c) {
    terms.push_back(library.terms[selection.chosen[c]]);
    coefficients.push_back(terms.back().size * selection.fit.coefficients[c]);
  }
  Screened start;
  start.start = formula_use("residual", library.adds_to, terms, coefficients, last.fit.model.file.linear);
  if (start.start.entry == nullptr) return {};
  start.entry = start.start.entry;
  start.name = effect_name(start.start);
  start.share = selection.fit.gain / base.energy();
  start.prior_share = (selection.fit.gain - selection.fit.data_gain) / base.energy();
  RefitSetup setup;
  setup.predictor = task.predictor;
  setup.splits = task.splits;
  setup.unweighted = task.unweighted;
  setup.nominal = task.nominal;
  setup.seed = task.seed;
  setup.jobs = task.jobs;
  setup.stop = stop;
  const Fitted with = refit(setup, last, start);
  const AcceptanceResult acceptance =
      test_acceptance(task.acceptance_context, last, with, start.name, kLeastSignalToNull);
  if (!acceptance.accepted()) return {};
  for (const EffectUse& use : with.fit.model.effects) {
    if (effect_name(use) == start.name) return {.use = use, .gain = 1.0 - acceptance.holdout.ratio};
  }
  return {};
}

}  // namespace

UnknownStructure unknown_structure(const SelectionTask& task, const Fitted& last,
                                   const Comparison& comparison, const std::function<bool()>& stop) {
  UnknownStructure out;
  const WhitenedResiduals& fit = (*task.splits)[kTraining];
  Eigen::VectorXd scale = fit.mean_square(last.residual[kTraining]).cwiseSqrt();
  const LinearBase base(fit, last.fit.model, unknowns_with_priors(last.fit.model, *task.nominal), scale,
                        task.jobs);
  out.curves = telling_curves(comparison);
  if (!base.usable()) return out;
  DataScale data;
  const Eigen::VectorXd speed = fit.track(last.fit.model, "speed");
  data.top_speed_rad_s = largest_size({speed.data(), static_cast<std::size_t>(speed.size())});
  for (const OrderPeak& p : strong_orders(*task.predictor, fit, last.fit.model, base.residual(), 3)) {
    data.orders.push_back(p.order);
  }
  out.where = where_of(comparison, data.orders.empty() ? 0.0 : data.orders.front());
  const bool no_formulas =
      task.dataset->rig->of_robot || !task.predictor->applies(example_expression()->entry).empty();
  if (no_formulas) return out;
  std::vector<Eigen::VectorXd> noise;
  for (const Eigen::VectorXd& n : task.null->fit_noise) noise.push_back(n.cwiseProduct(base.weights()));
  Found best;
  std::vector<UnknownTerm> of_torque = torque_terms(last.fit.model, data, torque_scale(task, last.fit.model));
  // Where the motion is imposed that torque is what the law itself makes needed (needed_torque.h), to be solved for in each
  // sub-step: a fit of minutes, beside the catalogue's own losses of the torque.
  if (task.predictor->method() == Method::kInverse)
    std::erase_if(of_torque, [](const UnknownTerm& t) { return t.of_motor_torque; });
  const Library torque = library_of(task, last, base, "torque_Nm", std::move(of_torque));
  const Library voltage = library_of(task, last, base, "voltage_V", voltage_terms(last.fit.model, data));
  for (const Library* library : {&torque, &voltage}) {
    if (library->terms.empty()) continue;
    Found found = formula_of(task, last, base, *library, noise, stop);
    if (found.gain > best.gain) best = std::move(found);
  }
  if (best.gain > 0.0) {
    const Expression* expression = expression_of(best.use);
    out.formula = expression->text.adds_to + " += " + expression->text.formula;
    out.expression_toml = write_expression(best.use);
  }
  return out;
}

}  // namespace omnihil
