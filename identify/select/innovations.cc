#include "identify/select/innovations.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "identify/select/idle_effect.h"
#include "identify/select/plausibility.h"
#include "sim/law/symmetric.h"

namespace omnihil {
namespace {

// Of the largest information: far above rounding, below any real one. Numerical.
constexpr double kRidge = 1e-12;  // numerical: a choice
constexpr const char* kPrefix = "by the innovations: ";
constexpr std::size_t kMostRefits = 6;  // by cost: a refit takes seconds

// The largest first.
std::vector<std::size_t> shortlist(const std::vector<Screened>& screened) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < screened.size(); ++i) {
    const bool random = (screened[i].entry->info->claims & kRandom) != 0;
    if (screened[i].share >= kLeastFitGain && screened[i].is_resolved() && !random) out.push_back(i);
  }
  std::ranges::stable_sort(
      out, [&](std::size_t a, std::size_t b) { return screened[a].share > screened[b].share; });
  if (out.size() > kMostRefits) out.resize(kMostRefits);
  return out;
}

}  // namespace

Innovations::Innovations(const SelectionTask& task, const Fitted& parent)
    : task_(task), spectrum_((*task.splits)[kTraining], parent.residual[kTraining]), null_(*task.null) {
  const WhitenedResiduals& training = (*task.splits)[kTraining];
  const Eigen::VectorXd plain = null_.floor(Split::kTraining);
  for (std::size_t k = 0; k < null_.fit_noise.size(); ++k) {
    if (null_.fit_noise[k].size() == 0) continue;
    null_.fit_noise[k] = spectrum_.flattened(training, null_.fit_noise[k]);
    null_.mean_square[kTraining].row(static_cast<Eigen::Index>(k)) =
        training.mean_square(null_.fit_noise[k]).transpose();
  }
  const Eigen::VectorXd flat = null_.floor(Split::kTraining);
  for (const Split split : {Split::kValidation, Split::kExtrapolation}) {
    for (Eigen::Index c = 0; c < plain.size(); ++c)
      null_.mean_square[split].col(c) *= plain[c] > 0.0 ? flat[c] / plain[c] : 0.0;
  }
  task_.null = &null_;
  task_.acceptance_context.null = &null_;
  if (task.acceptance_context.base != nullptr) {
    for (std::size_t u = 0; u < kSplits; ++u)
      base_[u] = spectrum_.flattened((*task.splits)[u], (*task.acceptance_context.base)[u]);
    task_.acceptance_context.base = &base_;
  }
  parent_ = of(parent);
}

Fitted Innovations::of(const Fitted& model) const {
  Fitted out = model;
  for (std::size_t u = 0; u < kSplits; ++u)
    out.residual[u] = spectrum_.flattened((*task_.splits)[u], model.residual[u]);
  return out;
}

std::string Innovations::not_its_own(const Candidate& model, const std::string& name) const {
  const WhitenedResiduals& training = (*task_.splits)[kTraining];
  const auto residual = [&](const Candidate& of) {
    return spectrum_.flattened(training, training.residual(of, task_.jobs));
  };
  return gain_not_its_own(training, residual(model), residual(with_idle_effect(model, name)));
}

bool Innovations::is_worth(const Fitted& model) const {
  if (!model.finite) return false;
  const Eigen::VectorXd left = spectrum_.flattened((*task_.splits)[kTraining], model.residual[kTraining]);
  return left.squaredNorm() < (1.0 - kLeastFitGain) * parent_.residual[kTraining].squaredNorm();
}

// Derivatives by the unknowns in units of their scale, flattened, and the information with the priors'.
Innovations::Linearised Innovations::linearised(const FitResult& fit) const {
  const WhitenedResiduals& training = (*task_.splits)[kTraining];
  Linearised out{.jacobian = training.derivatives(fit.model, fit.unknowns, task_.jobs), .information = {}};
  spectrum_.flatten(training, out.jacobian);
  for (Eigen::Index i = 0; i < out.jacobian.cols(); ++i)
    out.jacobian.col(i) *= fit.unknowns[static_cast<std::size_t>(i)].scale;
  out.information = out.jacobian.transpose() * out.jacobian;
  for (Eigen::Index i = 0; i < out.jacobian.cols(); ++i) {
    const Unknown& u = fit.unknowns[static_cast<std::size_t>(i)];
    const double value = fit.parameters[static_cast<std::size_t>(i)].value;
    if (u.prior_sigma > 0.0) out.information(i, i) += std::pow(u.scale * prior_dz(u, value), 2);
  }
  out.information.diagonal().array() += kRidge * std::max(1.0, out.information.diagonal().maxCoeff());
  return out;
}

Fitted Innovations::with_sigmas(const Fitted& model) const {
  Fitted out = of(model);
  if (!model.finite) return out;
  const std::vector<Unknown>& unknowns = model.fit.unknowns;
  const Eigen::MatrixXd information = linearised(model.fit).information;
  const Eigen::Index n = information.rows();
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = unknowns[static_cast<std::size_t>(i)].scale;
  out.fit.covariance = scale.asDiagonal() * ldlt_solve_columns(information, Eigen::MatrixXd::Identity(n, n)) *
                       scale.asDiagonal();
  for (Eigen::Index i = 0; i < n; ++i)
    out.fit.parameters[static_cast<std::size_t>(i)].sigma =
        std::sqrt(std::max(0.0, out.fit.covariance(i, i)));
  return out;
}

Fitted Innovations::refitted(Fitted model, const std::vector<Eigen::Index>& own) const {
  constexpr int kSteps = 4;            // by cost: derivatives of all runs each
  constexpr double kConverged = 1e-4;  // of an unknown's scale, or of the cost: a choice
  const WhitenedResiduals& training = (*task_.splits)[kTraining];
  // Minus two log of the posterior, but for a constant.
  const auto cost = [&](const Fitted& f) {
    double sum = of(f).residual[kTraining].squaredNorm();
    for (const Eigen::Index u : own) {
      const auto i = static_cast<std::size_t>(u);
      if (f.fit.unknowns[i].prior_sigma > 0.0)
        sum += std::pow(prior_z(f.fit.unknowns[i], f.fit.parameters[i].value), 2);
    }
    return sum;
  };
  double least = cost(model);
  for (int k = 0; k < kSteps; ++k) {
    const Linearised at = linearised(model.fit);
    const Eigen::VectorXd residual = spectrum_.flattened(training, model.residual[kTraining]);
    Eigen::MatrixXd information(own.size(), own.size());
    Eigen::VectorXd gradient(own.size());
    for (Eigen::Index i = 0; i < gradient.size(); ++i) {
      const Eigen::Index u = own[static_cast<std::size_t>(i)];
      const Unknown& unknown = model.fit.unknowns[static_cast<std::size_t>(u)];
      const double value = model.fit.parameters[static_cast<std::size_t>(u)].value;
      gradient[i] = at.jacobian.col(u).dot(residual);
      if (unknown.prior_sigma > 0.0)
        gradient[i] -= unknown.scale * prior_z(unknown, value) * prior_dz(unknown, value);
      for (Eigen::Index j = 0; j < gradient.size(); ++j)
        information(i, j) = at.information(u, own[static_cast<std::size_t>(j)]);
    }
    const Eigen::VectorXd step = ldlt_solve(information, gradient);
    FitResult fit = model.fit;
    std::vector<Unknown> unknowns;
    std::vector<double> values;
    for (Eigen::Index i = 0; i < step.size(); ++i) {
      const auto u = static_cast<std::size_t>(own[static_cast<std::size_t>(i)]);
      const Unknown& unknown = fit.unknowns[u];
      ParameterEstimate& p = fit.parameters[u];
      p.value = std::clamp(p.value + unknown.scale * step[i], unknown.lower, unknown.upper);
      p.prior_deviation_sigmas = prior_z(p, p.value);
      p.at_bound = p.value <= unknown.lower || p.value >= unknown.upper;
      unknowns.push_back(unknown);
      values.push_back(p.value);
    }
    fit.model = with_values(fit.model, unknowns, values);
    Fitted next = fitted(*task_.splits, *task_.unweighted, std::move(fit), task_.jobs);
    const double left = next.finite ? cost(next) : least;
    if (!(left < least)) break;
    const bool converged = step.cwiseAbs().maxCoeff() < kConverged || left > (1.0 - kConverged) * least;
    model = std::move(next);
    least = left;
    if (converged) break;
  }
  return model;
}

std::vector<Screened> Innovations::screened(const std::vector<Screened>& plain) const {
  const WhitenedResiduals& training = (*task_.splits)[kTraining];
  std::vector<Unknown> base = unknowns_with_priors(parent_.fit.model, *task_.nominal);
  Eigen::MatrixXd jacobian = training.derivatives(parent_.fit.model, base, task_.jobs);
  spectrum_.flatten(training, jacobian);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(jacobian);
  const Eigen::MatrixXd span =
      qr.householderQ() * Eigen::MatrixXd::Identity(jacobian.rows(), jacobian.cols());
  const Eigen::VectorXd& residual = parent_.residual[kTraining];
  std::vector<Screened> out = plain;
  for (Screened& s : out) {
    s.gain = s.null_gain = s.share = 0.0;
    if (!s.tried || s.columns.rows() != residual.size()) continue;
    Eigen::MatrixXd columns = s.columns;
    spectrum_.flatten(training, columns);
    columns -= span * (span.transpose() * columns);
    const Eigen::MatrixXd gram = columns.transpose() * columns;
    const auto gain = [&](const Eigen::VectorXd& r) {
      return bounded_gain(gram, columns.transpose() * r, s.two_sided).first;
    };
    for (const Eigen::VectorXd& n : null_.fit_noise)
      if (n.size() == residual.size()) s.null_gain = std::max(s.null_gain, gain(n));
    s.gain = gain(residual);
    s.share = std::max(0.0, s.gain - s.null_gain) / std::max(residual.squaredNorm(), 1e-300);
  }
  return out;
}

AcceptanceResult test_by_innovations(const SelectionTask& task, const Fitted& parent, const Fitted& child,
                                     const std::string& name) {
  const Innovations view(task, parent);
  AcceptanceResult out =
      test_acceptance(view.context(), view.parent(), view.with_sigmas(child), name, kScreenedBefore);
  if (out.accepted()) out.refuse(view.not_its_own(child.fit.model, name));
  out.why.insert(0, kPrefix);
  return out;
}

Fitted numbers_by_innovations(const SelectionTask& task, Fitted model,
                              const std::vector<std::string>& effects) {
  std::vector<Eigen::Index> own;
  for (std::size_t i = 0; i < model.fit.unknowns.size(); ++i) {
    const std::string& path = model.fit.unknowns[i].path;
    if (std::ranges::any_of(effects, [&](const std::string& e) { return path.starts_with(e + "."); }))
      own.push_back(static_cast<Eigen::Index>(i));
  }
  if (own.empty() || !model.finite) return model;
  const Innovations view(task, model);
  model = view.refitted(std::move(model), own);
  const Fitted with_sigmas = view.with_sigmas(model);
  for (const Eigen::Index i : own) {
    ParameterEstimate& p = model.fit.parameters[static_cast<std::size_t>(i)];
    p.sigma = with_sigmas.fit.parameters[static_cast<std::size_t>(i)].sigma;
    p.identifiable = true;
    p.correlated_with.clear();
    if (!p.at_bound) p.sentence.clear();
  }
  return model;
}

std::optional<InnovationChoice> choice_by_innovations(const SelectionTask& task, const RefitSetup& thorough,
                                                      const Fitted& parent, const Iteration& plain) {
  const Innovations view(task, parent);
  std::vector<Screened> screened = view.screened(plain.screened);
  const std::vector<std::size_t> chosen = shortlist(screened);
  if (chosen.empty()) return std::nullopt;
  InnovationChoice out{.iteration = refitted_as_well(task, parent, chosen, plain), .fitted = {}};
  Iteration& iteration = out.iteration;
  iteration.screened = std::move(screened);
  iteration.largest_null_gain = 0.0;
  for (const Screened& s : iteration.screened)
    iteration.largest_null_gain = std::max(iteration.largest_null_gain, s.null_gain);
  for (CandidateEffect& c : iteration.candidates) {
    c.fitted = view.is_worth(c.fitted) ? view.with_sigmas(c.fitted) : view.of(c.fitted);
    c.not_its_own.clear();  // of the plain residual; here of what is chosen
    const auto now = std::ranges::find(iteration.screened, c.screened.name, &Screened::name);
    if (now != iteration.screened.end()) c.screened = *now;
  }
  judge_anew(view.task(), view.parent(), iteration);
  while (iteration.chosen >= 0 && !iteration.stopped) {
    const CandidateEffect& best = iteration.candidates[static_cast<std::size_t>(iteration.chosen)];
    out.fitted = numbers_by_innovations(
        task, refit_to_convergence(thorough, refit_as_it_is(thorough, best.fitted.fit.model, 1)),
        {best.screened.name});
    std::string why = ends_at_bound(out.fitted.fit, best.screened.name);
    if (why.empty()) why = view.not_its_own(out.fitted.fit.model, best.screened.name);
    if (why.empty()) {
      for (RankedEffect& r : iteration.ranking)
        if (r.refitted) r.why.insert(0, kPrefix);
      return out;
    }
    refuse_chosen(view.task(), view.parent(), why, iteration);
  }
  return std::nullopt;
}

}  // namespace omnihil
