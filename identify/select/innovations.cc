#include "identify/select/innovations.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "identify/select/plausibility.h"
#include "sim/law/symmetric.h"

namespace omnihil {
namespace {

constexpr const char* kPrefix = "by the innovations: ";
constexpr std::size_t kMostRefits = 6;  // by cost: a refit takes seconds
// Share of the innovations' energy from which a refit is worth it: the least gain on the fit runs that is accepted (acceptance.cc).
constexpr double kLeastShare = 0.015;  // tuned, as the acceptance test's

// The largest first.
std::vector<std::size_t> shortlist(const std::vector<Screened>& screened) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < screened.size(); ++i) {
    const bool random = (screened[i].entry->info->claims & kRandom) != 0;
    if (screened[i].share >= kLeastShare && screened[i].is_resolved() && !random) out.push_back(i);
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

bool Innovations::is_worth(const Fitted& model) const {
  if (!model.finite) return false;
  const Eigen::VectorXd left = spectrum_.flattened((*task_.splits)[kTraining], model.residual[kTraining]);
  return left.squaredNorm() < (1.0 - kLeastShare) * parent_.residual[kTraining].squaredNorm();
}

Fitted Innovations::with_sigmas(const Fitted& model) const {
  Fitted out = of(model);
  if (!model.finite) return out;
  const WhitenedResiduals& training = (*task_.splits)[kTraining];
  const std::vector<Unknown>& unknowns = model.fit.unknowns;
  Eigen::MatrixXd jacobian = training.derivatives(model.fit.model, unknowns, task_.jobs);
  spectrum_.flatten(training, jacobian);
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i)
    jacobian.col(i) *= unknowns[static_cast<std::size_t>(i)].scale;
  Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
    const Unknown& u = unknowns[static_cast<std::size_t>(i)];
    if (u.prior_sigma > 0.0)
      information(i, i) +=
          std::pow(u.scale * prior_dz(u, model.fit.parameters[static_cast<std::size_t>(i)].value), 2);
  }
  information.diagonal().array() += 1e-12 * std::max(1.0, information.diagonal().maxCoeff());
  Eigen::MatrixXd covariance =
      ldlt_solve_columns(information, Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    const double scale = unknowns[static_cast<std::size_t>(i)].scale;
    covariance.row(i) *= scale;
    covariance.col(i) *= scale;
  }
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    out.fit.parameters[static_cast<std::size_t>(i)].sigma = std::sqrt(std::max(0.0, covariance(i, i)));
  out.fit.covariance = std::move(covariance);
  return out;
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
  out.why.insert(0, kPrefix);
  return out;
}

std::optional<InnovationChoice> choice_by_innovations(const SelectionTask& task, const RefitSetup& thorough,
                                                      const Fitted& parent, const Iteration& plain) {
  const Innovations view(task, parent);
  const std::vector<Screened> screened = view.screened(plain.screened);
  const std::vector<std::size_t> chosen = shortlist(screened);
  if (chosen.empty()) return std::nullopt;
  InnovationChoice out{.iteration = refitted_as_well(task, parent, chosen, plain), .fitted = {}};
  Iteration& iteration = out.iteration;
  iteration.screened = screened;
  iteration.largest_null_gain = 0.0;
  for (const Screened& s : screened)
    iteration.largest_null_gain = std::max(iteration.largest_null_gain, s.null_gain);
  for (CandidateEffect& c : iteration.candidates) {
    c.fitted = view.is_worth(c.fitted) ? view.with_sigmas(c.fitted) : view.of(c.fitted);
    const auto now = std::ranges::find(screened, c.screened.name, &Screened::name);
    if (now != screened.end()) c.screened = *now;
  }
  judge_anew(view.task(), view.parent(), iteration);
  while (iteration.chosen >= 0 && !iteration.stopped) {
    const CandidateEffect& best = iteration.candidates[static_cast<std::size_t>(iteration.chosen)];
    out.fitted = refit_to_convergence(thorough, refit_as_it_is(thorough, best.fitted.fit.model, 1));
    const std::string why = ends_at_bound(out.fitted.fit, best.screened.name);
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
