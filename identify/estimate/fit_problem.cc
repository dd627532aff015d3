#include "identify/estimate/fit_problem.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "identify/record/parallel.h"
#include "identify/record/statistics.h"
#include "sim/law/scalar.h"

namespace omnihil {
namespace {

// In units of s_c. Six, far beyond the 1.345 of full robustness: the residual of a wrong model is not
// Gaussian and must keep its weight in a search, a glitch is farther out. A choice; sensitivity not measured.
constexpr double kHuber = 6.0;          // a choice
constexpr double kRobustHuber = 1.345;  // Holland, Welsch 1977; a choice

// Residual of one signal, whitened, zero where it was not measured.
Eigen::VectorXd residual_of(const ComparedSignal& signal, const std::vector<double>& model) {
  std::vector<double> r(signal.measured.size());
  for (std::size_t k = 0; k < r.size(); ++k) r[k] = signal.measured[k] - model[k];
  r = whitened(signal, std::move(r));
  Eigen::VectorXd out(static_cast<Eigen::Index>(r.size()));
  for (std::size_t k = 0; k < r.size(); ++k)
    out[static_cast<Eigen::Index>(k)] = std::isfinite(signal.measured[k]) ? r[k] : 0.0;
  return out;
}

// Autocorrelation time of n samples: 1 + 2 sum of autocorrelations, up to a window of five such times (Sokal
// 1997). Gaps count as zero. At most n / 10 lags, or 4000: bounds the cost; a choice.
double autocorrelation_time(const Eigen::VectorXd& r) {
  const Eigen::Index n = r.size();
  const double energy = r.squaredNorm();
  if (n < 8 || !(energy > 0.0)) return 1.0;
  constexpr double kWindow = 5.0;  // source: Sokal 1997, 4 to 10, truncation against noise of the sum
  double time = 1.0;
  const Eigen::Index longest = std::min<Eigen::Index>(n / 10, 4000);
  for (Eigen::Index lag = 1; lag < longest; ++lag) {
    time += 2.0 * r.head(n - lag).dot(r.tail(n - lag)) / energy;
    if (static_cast<double>(lag) > kWindow * time) break;
  }
  return std::max(1.0, time);
}

std::size_t passes_of(std::size_t unknowns) { return (unknowns + kJetWidth - 1) / kJetWidth; }

}  // namespace

FitProblem::FitProblem(const Predictor& predictor, const Candidate& candidate,
                       const std::vector<Unknown>& unknowns, int jobs, bool robust, bool near_enough)
    : predictor_(predictor),
      candidate_(candidate),
      unknowns_(unknowns),
      jobs_(jobs),
      robust_(robust),
      near_enough_(near_enough && predictor.is_costly()) {
  for (int run = 0; run < predictor.run_count(); ++run) {
    if (predictor.run(run).split == Split::kTraining && !predictor.compared(run).empty())
      runs_.push_back(run);
  }
  longest_first_.resize(runs_.size());
  std::iota(longest_first_.begin(), longest_first_.end(), std::size_t{0});
  std::ranges::stable_sort(longest_first_, std::greater<>(),
                           [&](std::size_t n) { return predictor.run(runs_[n]).time_s.size(); });
}

std::unique_ptr<FitProblem> FitProblem::beside() const {
  auto out = std::make_unique<FitProblem>(predictor_, candidate_, unknowns_, jobs_, robust_);
  out->weights_ = weights_;
  return out;
}

Candidate FitProblem::candidate_at(const Eigen::VectorXd& x) const {
  return with_values(candidate_, unknowns_, std::span(x.data(), static_cast<std::size_t>(x.size())));
}

std::vector<std::vector<Eigen::VectorXd>> FitProblem::residuals(const Eigen::VectorXd& x,
                                                                bool& finite) const {
  const auto kept = predicted(x);
  const std::vector<Prediction>& all_predicted = *kept;
  std::vector<std::vector<Eigen::VectorXd>> all(runs_.size());
  parallel_for(jobs_, static_cast<int>(runs_.size()), [&](int n) {
    const auto i = static_cast<std::size_t>(n);
    const std::vector<ComparedSignal>& compared = predictor_.compared(runs_[i]);
    for (std::size_t s = 0; s < compared.size(); ++s)
      all[i].push_back(residual_of(compared[s], all_predicted[i].values[s]));
  });
  finite =
      std::all_of(all_predicted.begin(), all_predicted.end(), [](const Prediction& p) { return p.finite; });
  return all;
}

std::shared_ptr<const std::vector<Prediction>> FitProblem::predicted(const Eigen::VectorXd& x) const {
  return predicted_.of(x, [&] {
    const Candidate c = candidate_at(x);
    std::vector<Prediction> made(runs_.size());
    parallel_for(jobs_, static_cast<int>(runs_.size()), [&](int k) {
      const std::size_t n = longest_first_[static_cast<std::size_t>(k)];
      made[n] = predictor_.predict(c, runs_[n]);
    });
    return made;
  });
}

bool FitProblem::reweigh(const Eigen::VectorXd& x) {
  bool finite = true;
  const auto all = residuals(x, finite);
  if (!finite) return false;
  struct Sum {
    double square = 0.0, count = 0.0, noise = 0.0, time = 0.0;
  };
  std::map<std::string, Sum> sums;
  std::map<std::string, std::vector<double>> all_sizes;
  for (int pass = 0; pass < 3; ++pass) {  // trimmed rms: without samples beyond kHuber of the pass before
    std::map<std::string, Sum> next;
    for (std::size_t n = 0; n < runs_.size(); ++n) {
      const auto& compared = predictor_.compared(runs_[n]);
      for (std::size_t s = 0; s < compared.size(); ++s) {
        Sum& sum = next[compared[s].name];
        const Eigen::VectorXd& r = all[n][s];
        const auto before = sums.find(compared[s].name);
        const double limit = before == sums.end()
                                 ? INFINITY
                                 : kHuber * std::sqrt(before->second.square / before->second.count);
        double count = 0.0;
        for (Eigen::Index k = 0; k < r.size(); ++k) {
          if (!std::isfinite(compared[s].measured[static_cast<std::size_t>(k)]) || !(std::abs(r[k]) <= limit))
            continue;
          sum.square += r[k] * r[k];
          count += 1.0;
          if (robust_ && pass == 0) all_sizes[compared[s].name].push_back(std::abs(r[k]));
        }
        sum.count += count;
        sum.noise += count * compared[s].whitened_sigma * compared[s].whitened_sigma;
        if (pass == 2) sum.time += count * autocorrelation_time(r);
      }
    }
    sums = std::move(next);
  }
  weights_.clear();
  for (const auto& [name, sum] : sums) {
    if (!(sum.count > 0.0)) continue;
    double size = std::sqrt(std::max(sum.square, sum.noise) / sum.count);
    if (robust_) size = std::max(sigma_by_mad(all_sizes[name]), std::sqrt(sum.noise / sum.count));
    weights_[name] = {.size = size > 0.0 ? size : 1.0,
                      .autocorrelation = std::max(1.0, sum.time / sum.count),
                      .samples = sum.count};
  }
  return true;
}

FitProblem::RunPart FitProblem::part(int run, const Prediction& values,
                                     const std::vector<const Prediction*>& strides, Eigen::Index n) const {
  RunPart out;
  out.finite = values.finite;
  if (!strides.empty()) {
    out.gradient = Eigen::VectorXd::Zero(n);
    out.information = Eigen::MatrixXd::Zero(n, n);
  }
  const double huber = robust_ ? kRobustHuber : kHuber;
  const std::vector<ComparedSignal>& compared = predictor_.compared(run);
  for (std::size_t s = 0; s < compared.size() && out.finite; ++s) {
    const auto found = weights_.find(compared[s].name);
    if (found == weights_.end()) continue;
    const SignalWeight& w = found->second;
    Eigen::VectorXd r = residual_of(compared[s], values.values[s]) / w.size;
    Eigen::VectorXd weight(r.size());  // square root of each sample's weight
    for (Eigen::Index k = 0; k < r.size(); ++k) {
      const double a = std::abs(r[k]);
      const bool known = std::isfinite(compared[s].measured[static_cast<std::size_t>(k)]);
      // rho(z) = z within, 2 c sqrt(z) - c^2 beyond; rho' = c / a
      out.cost +=
          known ? 0.5 * (a <= huber ? a * a : 2.0 * huber * a - huber * huber) / w.autocorrelation : 0.0;
      weight[k] = known ? std::sqrt((a <= huber ? 1.0 : huber / a) / w.autocorrelation) : 0.0;
    }
    if (strides.empty()) continue;
    Eigen::MatrixXd j(r.size(), n);
    Eigen::Index first = 0;
    for (const Prediction* p : strides) {
      const Eigen::MatrixXd& d = p->derivatives[s];
      j.middleCols(first, d.cols()) = d;
      first += d.cols();
    }
    whiten(compared[s], j);
    j.array().colwise() *= weight.array() / w.size;
    r.array() *= weight.array();
    out.information.noalias() += j.transpose() * j;
    out.gradient.noalias() -= j.transpose() * r;  // r = measured - model
  }
  out.finite = out.finite && std::isfinite(out.cost);
  return out;
}

FitPoint FitProblem::at(const Eigen::VectorXd& x, bool derivatives) const {
  return evaluated(x, derivatives ? std::span<const Unknown>(unknowns_) : std::span<const Unknown>(), 0);
}

FitPoint FitProblem::along(const Eigen::VectorXd& x, Eigen::Index unknown) const {
  return evaluated(x, std::span(unknowns_).subspan(static_cast<std::size_t>(unknown), 1), unknown);
}

bool FitProblem::near_derived(const Eigen::VectorXd& x) const {
  constexpr double kNear = 0.1;  // of an unknown's scale: its derivatives change by about as much; a choice
  if (!near_enough_ || derived_.x.size() != x.size()) return false;
  if (!std::ranges::all_of(derived_.runs, [](const Prediction& p) { return p.finite; })) return false;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (std::abs(x[i] - derived_.x[i]) > kNear * unknowns_[static_cast<std::size_t>(i)].scale) return false;
  }
  return true;
}

// All passes of a run one after another.
std::vector<Prediction> FitProblem::derived(const Eigen::VectorXd& x, std::span<const Unknown> by) const {
  const Candidate c = candidate_at(x);
  const std::size_t passes = passes_of(by.size());
  std::vector<Prediction> out(runs_.size() * passes);
  parallel_for(jobs_, static_cast<int>(out.size()), [&](int task) {
    const auto t = static_cast<std::size_t>(task);
    const std::size_t n = longest_first_[t / passes], begin = t % passes * kJetWidth;
    const auto some = by.subspan(begin, std::min<std::size_t>(kJetWidth, by.size() - begin));
    out[n * passes + t % passes] = predictor_.predict_with_derivatives(c, some, runs_[n]);
  });
  return out;
}

// Derivatives by the unknowns `by`, which begin at `first` of all.
FitPoint FitProblem::evaluated(const Eigen::VectorXd& x, std::span<const Unknown> by,
                               Eigen::Index first) const {
  const std::size_t n = by.size();
  const std::size_t strides = passes_of(n);
  const bool all = n == unknowns_.size() && n > 0;
  const bool same = derived_.x.size() == x.size() && derived_.x == x;
  const bool nearby = all && !same && near_derived(x);
  std::vector<Prediction> some;
  if (all && !nearby && !same) derived_ = {.x = x, .runs = derived(x, by)};
  if (!all) some = derived(x, by);
  const std::vector<Prediction>& derived = all ? derived_.runs : some;
  const auto plain = strides == 0 || nearby ? predicted(x) : nullptr;
  std::vector<RunPart> parts(runs_.size());
  parallel_for(jobs_, static_cast<int>(runs_.size()), [&](int r) {
    const auto i = static_cast<std::size_t>(r);
    std::vector<const Prediction*> own;
    for (std::size_t s = 0; s < strides; ++s) own.push_back(&derived[i * strides + s]);
    parts[i] = part(runs_[i], plain != nullptr ? (*plain)[i] : derived[i * strides], own,
                    static_cast<Eigen::Index>(n));
  });
  FitPoint out;
  out.finite = true;
  out.gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  out.information = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  for (const RunPart& p : parts) {
    out.finite = out.finite && p.finite;
    out.data_cost += p.cost;
    if (strides == 0 || !p.finite) continue;
    out.gradient += p.gradient;
    out.information += p.information;
  }
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    if (unknowns_[u].prior_sigma <= 0.0) continue;
    const auto i = static_cast<Eigen::Index>(u);
    const double z = prior_z(unknowns_[u], x[i]);
    out.prior_cost += 0.5 * z * z;
    const Eigen::Index at = i - first;
    if (at >= 0 && at < out.gradient.size()) out.gradient[at] += z * prior_dz(unknowns_[u], x[i]);
  }
  out.finite = out.finite && out.gradient.allFinite() && out.information.allFinite();
  return out;
}

double FitProblem::noise_cost(const Eigen::VectorXd& x) const {
  bool finite = true;
  const auto all = residuals(x, finite);
  double sum = 0.0;
  for (std::size_t n = 0; n < runs_.size(); ++n) {
    const auto& compared = predictor_.compared(runs_[n]);
    for (std::size_t s = 0; s < compared.size(); ++s) {
      const double sigma = compared[s].whitened_sigma;
      if (sigma > 0.0) sum += all[n][s].squaredNorm() / (sigma * sigma);
    }
  }
  return sum;
}

}  // namespace omnihil
