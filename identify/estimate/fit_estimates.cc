#include "identify/estimate/fit_estimates.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/law/symmetric.h"

namespace omnihil {
namespace {

// Share of the largest eigenvalue below which a direction is not determined by the data. Between rounding of
// J'J (1e-16 times the samples' number) and any real information; numerical, sensitivity not measured.
constexpr double kNothing = 1e-9;  // numerical: a choice

// Eigenvectors of the information matrix, unknowns in units of their scale, so that directions can be
// compared.
struct Directions {
  Eigen::VectorXd strength;  // size p: eigenvalues of the scaled information, ascending
  Eigen::MatrixXd members;   // p x p: eigenvectors, as columns
};

Directions directions_of(const Eigen::MatrixXd& information, const Eigen::VectorXd& scale) {
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  SymmetricEigen eigen = symmetric_eigen(scaled);
  return {std::move(eigen.values), std::move(eigen.vectors)};
}

double data_variance(const Directions& d, Eigen::Index i, double scale) {
  const double largest = std::max(d.strength.tail(1)[0], std::numeric_limits<double>::min());
  double variance = 0.0;
  for (Eigen::Index e = 0; e < d.strength.size(); ++e) {
    const double part = d.members(i, e) * d.members(i, e);
    if (d.strength[e] > kNothing * largest) {
      variance += part / d.strength[e];
    } else if (part > 1e-6) {
      return std::numeric_limits<double>::infinity();
    }
  }
  return variance * scale * scale;
}

// The unknowns that unknown i is strongly correlated with in the data's own covariance, made finite by a
// prior sigma of a hundred times each scale; strongest first.
std::vector<std::string> partners(const Eigen::MatrixXd& information, const Eigen::VectorXd& scale,
                                  Eigen::Index i, const std::vector<Unknown>& unknowns) {
  constexpr double kWeak = 1e-4;       // derived: 1 / 100^2
  constexpr double kCorrelated = 0.5;  // a quarter of the variance in common; a choice
  constexpr std::size_t kMost = 3;     // names in a sentence; a choice
  Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  scaled.diagonal().array() += kWeak;
  const Eigen::MatrixXd covariance =
      ldlt_solve_columns(scaled, Eigen::MatrixXd::Identity(scaled.rows(), scaled.cols()));
  std::vector<std::pair<double, std::string>> found;
  for (Eigen::Index j = 0; j < scaled.rows(); ++j) {
    const double c = covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
    if (j != i && std::abs(c) > kCorrelated)
      found.emplace_back(-std::abs(c), unknowns[static_cast<std::size_t>(j)].path);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> out;
  for (std::size_t n = 0; n < found.size() && n < kMost; ++n) out.push_back(found[n].second);
  return out;
}

bool at(double x, double bound, double scale) {
  return std::abs(x - bound) <= 1e-6 * scale + 1e-12 * std::abs(bound);
}

bool is_shape(const Candidate& model, const Unknown& u) {
  if (u.effect < 0) return false;
  const EffectInfo& info = *model.effects[static_cast<std::size_t>(u.effect)].entry->info;
  return info.params[static_cast<std::size_t>(u.row)].role == ParamRole::kShape;
}

// Sentence for an estimate at its bound; a physical bound (no friction below zero) that the gradient presses
// on is told from a bound of the search, and from a shape's simplest form (a filter without steps).
std::string bound_sentence(const Unknown& u, double x, double data_gradient, bool is_shape) {
  const bool lower = at(x, u.lower, u.scale);
  if (lower && u.lower == 0.0 && is_shape) return "at its bound 0, the law's simplest form";
  const bool is_time = u.effect < 0 && u.unit == "s";  // a filter's time constant, a latency: zero is none
  if (lower && u.lower == 0.0 && is_time) return "at its bound 0: these data know of none";
  if (lower && data_gradient > 0.0 && u.lower == 0.0) {
    return fmt::format(
        "at its bound 0: these data would take a negative value, which no drive has; something else is "
        "missing or the record is a closed loop");
  }
  if (lower && data_gradient == 0.0)
    return "not determined by these data: they are the same down to its bound";
  return fmt::format("at its bound {:g} {}: read this as a symptom, not as a measurement",
                     lower ? u.lower : u.upper, u.unit);
}

std::string sentence_of(const Unknown& u, const ParameterEstimate& p, double data_gradient, bool is_shape) {
  if (p.at_bound) return bound_sentence(u, p.value, data_gradient, is_shape);
  if (!p.identifiable && !p.correlated_with.empty()) {
    return fmt::format("not determined by these data: trades against {}", fmt::join(p.correlated_with, ", "));
  }
  if (!p.identifiable) return "not determined by these data";
  constexpr double kDeviation = 3.0;  // two-sided p = 0.3 % of a normal prior: derived
  if (std::abs(p.prior_deviation_sigmas) > kDeviation && u.effect < 0) {
    return fmt::format("{:.1f} tolerances from what the model file believed: a missing effect may hide in it",
                       std::abs(p.prior_deviation_sigmas));
  }
  return "";
}

// Regression of the drive input (n samples) on the measured speed (n): {gain, R^2}.
std::pair<double, double> loop_gain(const std::vector<double>& u, const std::vector<double>& v) {
  double n = 0.0, su = 0.0, sv = 0.0, suu = 0.0, svv = 0.0, suv = 0.0;
  for (std::size_t k = 0; k < u.size() && k < v.size(); ++k) {
    if (!std::isfinite(u[k]) || !std::isfinite(v[k])) continue;
    n += 1.0, su += u[k], sv += v[k], suu += u[k] * u[k], svv += v[k] * v[k], suv += u[k] * v[k];
  }
  const double cuv = n * suv - su * sv, cvv = n * svv - sv * sv, cuu = n * suu - su * su;
  if (!(cvv > 0.0) || !(cuu > 0.0)) return {0.0, 0.0};
  return {cuv / cvv, cuv * cuv / (cvv * cuu)};
}

void name_closed_loop(const Predictor& predictor, const std::vector<Unknown>& unknowns,
                      const FitResult& result, std::vector<std::string>& findings) {
  constexpr double kFollows = 0.9;  // R^2 of the input on the speed; tuned, sensitivity not measured
  for (int n = 0; n < predictor.run_count(); ++n) {
    const Run& run = predictor.run(n);
    const std::vector<double>* speed = run.signal("velocity");
    if (run.split != Split::kTraining || run.steady || speed == nullptr) continue;
    for (const char* name : {"motor_torque", "motor_current", "duty", "motor_voltage"}) {
      const std::vector<double>* input = run.signal(name);
      if (input == nullptr) continue;
      const auto [gain, share] = loop_gain(*input, *speed);
      if (gain >= 0.0 || share < kFollows) continue;
      findings.push_back(
          fmt::format("{}: {} follows the measured speed with a gain of {:.3g} ({:.0f} % of it): a closed "
                      "loop. A fit of friction to "
                      "such a record finds minus the controller's gain",
                      run.file, name, gain, 100.0 * share));
      for (std::size_t i = 0; i < unknowns.size(); ++i) {
        if (unknowns[i].trait != ParamTrait::kDamping || !result.parameters[i].at_bound) continue;
        findings.push_back(unknowns[i].path + ": its bound is where the controller's gain ends up, see " +
                           run.file);
      }
      return;
    }
  }
}

}  // namespace

void describe(const FitProblem& problem, const Predictor& predictor, const FitPoint& point,
              const Eigen::VectorXd& x, FitResult& result) {
  const std::vector<Unknown>& unknowns = problem.unknowns();
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  Eigen::VectorXd scale(n), prior(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Unknown& u = unknowns[static_cast<std::size_t>(i)];
    scale[i] = u.scale;
    prior[i] = std::pow(prior_dz(u, x[i]), 2);
  }
  const Directions data = directions_of(point.information, scale);
  const Directions both = directions_of(point.information + Eigen::MatrixXd(prior.asDiagonal()), scale);
  Eigen::VectorXd inverse = both.strength;
  const double largest = n > 0 ? std::max(both.strength.tail(1)[0], 1e-300) : 1.0;
  for (double& e : inverse) e = 1.0 / std::max(e, 1e-14 * largest);
  const Eigen::MatrixXd root = scale.asDiagonal() * both.members;
  result.covariance = root * inverse.asDiagonal() * root.transpose();
  result.parameters.clear();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Unknown& u = unknowns[static_cast<std::size_t>(i)];
    ParameterEstimate p{.path = u.path, .unit = u.unit, .value = x[i], .correlated_with = {}, .sentence = {}};
    p.sigma = std::sqrt(std::max(0.0, result.covariance(i, i)));
    p.data_sigma = std::sqrt(data_variance(data, i, u.scale));
    p.prior_mean = u.prior_mean;
    p.prior_sigma = u.prior_sigma;
    p.prior_form = u.prior_form;
    p.prior_deviation_sigmas = prior_z(u, x[i]);
    p.at_bound =
        u.trait != ParamTrait::kPeriodic && (at(x[i], u.lower, u.scale) || at(x[i], u.upper, u.scale));
    // A strength that stays at neutral is at a bound too, but not pressed against it; nor is one that the prior alone takes
    // there, through a valley in which the data do not change (a dead band narrower than the least duty but zero).
    const double data_gradient = point.gradient[i] - prior_z(u, x[i]) * prior_dz(u, x[i]);
    const bool pressed = data_gradient * (at(x[i], u.lower, u.scale) ? 1.0 : -1.0) > 0.0;
    p.unphysical = p.at_bound && u.lower == 0.0 && at(x[i], 0.0, u.scale) && pressed;
    const double prior_width =
        u.prior_sigma > 0.0 ? 1.0 / prior_dz(u, x[i]) : std::max(std::abs(x[i]), u.scale);
    p.identifiable = p.data_sigma < prior_width;
    if (!p.identifiable) p.correlated_with = partners(point.information, scale, i, unknowns);
    p.sentence = sentence_of(u, p, data_gradient, is_shape(result.model, u));
    if (!p.sentence.empty()) result.findings.push_back(p.path + ": " + p.sentence);
    result.parameters.push_back(std::move(p));
  }
  name_closed_loop(predictor, unknowns, result, result.findings);
}

}  // namespace omnihil
