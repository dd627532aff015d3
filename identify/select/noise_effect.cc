#include "identify/select/noise_effect.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "identify/estimate/gain.h"
#include "identify/record/parallel.h"
#include "identify/select/effect_variants.h"
#include "identify/select/plausibility.h"
#include "sim/law/effect_registry.h"
#include "sim/law/random.h"
#include "sim/model/effect_reader.h"

namespace omnihil {
namespace {

// Sizes of the test: tuned on the open cases (DECISIONS 34); sensitivity not measured.
constexpr int kBins = 8;             // of equal numbers of samples, per channel and track; tuned
constexpr int kReplicates = 2;       // by cost: a simulation of all runs each
constexpr int kPasses = 3;           // of the estimate of the strength; by cost
constexpr double kExplained = 0.75;  // least fraction of the bins' excess variance, held out; tuned
constexpr double kExcess = 0.05;     // least excess over the sensors' variance; tuned
constexpr double kCorrelation =
    0.1;  // largest difference of the autocorrelations at any lag, beside its own error; a choice
// Samples over which an autocorrelation is compared; a choice, sensitivity not measured.
constexpr int kLags = 10;  // a choice

// Sums of squares of one split, by channel and bin: [track, channel, bin].
struct Energies {
  Eigen::VectorXd sum, count, fourth;
  Eigen::VectorXd mean() const { return sum.cwiseQuotient(count.cwiseMax(1.0)); }
  // Effective sample size: as many normal samples give the variance as well; var(r^2) = 2 sigma^4 makes 3
  // (sum r^2)^2 / sum r^4. Where a few edges hold most of the energy they are few, whatever the bin holds
  // (Kish 1965).
  Eigen::VectorXd weight() const {
    const Eigen::VectorXd normal = 3.0 * sum.cwiseAbs2().cwiseQuotient(fourth.cwiseMax(1e-300));
    return normal.cwiseMin(count);
  }
};

// A measured bus voltage is an input of the model: its residual is no noise of an effect.
bool counts(const Predictor& predictor, const WhitenedResiduals::Part& part) {
  return predictor.compared(part.run)[static_cast<std::size_t>(part.signal)].name != "bus_voltage";
}

// The bin of each sample, for two tracks: [sample], -1 in none; and the model's prediction there.
class Binning {
 public:
  Binning(const Predictor& predictor, const WhitenedResiduals& residuals, const Candidate& model)
      : predictor_(&predictor), residuals_(&residuals), predicted_(residuals.predicted(model)) {
    for (const char* name : {"speed", "acceleration"}) tracks_.push_back(bins(residuals.track(model, name)));
  }

  const WhitenedResiduals& residuals() const { return *residuals_; }
  const Eigen::VectorXd& predicted() const { return predicted_; }

  Energies energies(const Eigen::VectorXd& r) const {
    const auto channels = static_cast<std::size_t>(residuals_->samples().size());
    const Eigen::Index size = static_cast<Eigen::Index>(tracks_.size() * channels * kBins);
    Energies e{Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size)};
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      for (const WhitenedResiduals::Part& part : residuals_->parts()) {
        if (!counts(*predictor_, part)) continue;
        const std::size_t row = (t * channels + static_cast<std::size_t>(part.channel)) * kBins;
        for (Eigen::Index i = part.first; i < part.first + static_cast<Eigen::Index>(part.rows.size()); ++i) {
          const int bin = tracks_[t][static_cast<std::size_t>(i)];
          if (bin < 0 || !std::isfinite(r[i])) continue;
          const Eigen::Index at = static_cast<Eigen::Index>(row) + bin;
          e.sum[at] += r[i] * r[i];
          e.count[at] += 1.0;
          e.fourth[at] += r[i] * r[i] * r[i] * r[i];
        }
      }
    }
    return e;
  }

 private:
  static std::vector<int> bins(const Eigen::VectorXd& track) {
    std::vector<double> sizes;
    for (const double v : track) {
      if (std::isfinite(v)) sizes.push_back(std::abs(v));
    }
    std::sort(sizes.begin(), sizes.end());
    std::vector<int> out(static_cast<std::size_t>(track.size()), -1);
    constexpr std::size_t kLeastPerBin = 10;  // a variance to within 45 % (sqrt(2 / n)); a choice
    if (sizes.size() < kLeastPerBin * kBins) return out;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double v = std::abs(track[static_cast<Eigen::Index>(i)]);
      if (!std::isfinite(v)) continue;
      const auto below = std::lower_bound(sizes.begin(), sizes.end(), v) - sizes.begin();
      out[i] =
          std::min(kBins - 1, static_cast<int>(kBins * below / static_cast<std::ptrdiff_t>(sizes.size())));
    }
    return out;
  }

  const Predictor* predictor_;
  const WhitenedResiduals* residuals_;
  Eigen::VectorXd predicted_;
  std::vector<std::vector<int>> tracks_;
};

// The residual's autocorrelation at lags 1 to kLags: [channel, lag].
Eigen::VectorXd autocorrelations(const Predictor& predictor, const WhitenedResiduals& residuals,
                                 const Eigen::VectorXd& r) {
  const Eigen::Index channels = residuals.samples().size();
  Eigen::VectorXd products = Eigen::VectorXd::Zero(channels * kLags),
                  energy = Eigen::VectorXd::Zero(channels);
  for (const WhitenedResiduals::Part& part : residuals.parts()) {
    if (!counts(predictor, part)) continue;
    const auto n = static_cast<Eigen::Index>(part.rows.size());
    const auto own =
        r.segment(part.first, n).unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }).eval();
    energy[part.channel] += own.squaredNorm();
    for (Eigen::Index lag = 1; lag <= kLags && lag < n; ++lag) {
      products[part.channel * kLags + lag - 1] += own.head(n - lag).dot(own.tail(n - lag));
    }
  }
  for (Eigen::Index k = 0; k < channels; ++k)
    products.segment(k * kLags, kLags) /= std::max(energy[k], 1e-300);
  return products;
}

class Trial {
 public:
  Trial(const NoiseSearch& search, const EffectEntry& entry) : search_(search), entry_(entry) {
    const EffectInfo& info = *entry.info;
    shape_ = neutral_use(entry, *search.model);
    for (std::size_t i = 0; i < info.params.size(); ++i) {
      if (info.params[i].role == ParamRole::kStrength) row_ = i;
    }
  }

  std::optional<NoiseEffect> run() {
    const Splits& unweighted = *search_.unweighted;
    const WhitenedResiduals& fit = unweighted[kTraining];
    const Binning bins(*search_.predictor, fit, *search_.model);
    if (bins.predicted().size() != fit.size()) return std::nullopt;
    const Energies measured = bins.energies(fit.residual_of(bins.predicted()));
    const Eigen::VectorXd own = simulated(bins, 0.0);
    if (own.size() == 0) return std::nullopt;
    const EffectParam& row = entry_.info->params[row_];
    // A power law about a first guess, then about its estimate.
    double size = row.typical;
    for (int pass = 0; pass < kPasses; ++pass) {
      const double below = std::max(0.5 * size, 1e-12 * row.typical);
      Eigen::VectorXd more = simulated(bins, size), less = simulated(bins, below);
      if (more.size() == 0 || less.size() == 0) return std::nullopt;
      more -= own;
      less -= own;
      const double total = more.dot(measured.count), part = less.dot(measured.count);
      // Variances grow with the square of a strength unless it saturates: the exponent is kept near that.
      double power = 2.0;
      if (total > 0.0 && part > 0.0 && below < size) power = std::log(total / part) / std::log(size / below);
      const double next = most_likely(measured, own, more.cwiseMax(0.0), std::clamp(power, 0.5, 4.0), size);
      if (next <= 0.0) return std::nullopt;
      size = std::clamp(next, 1e-9 * row.typical, row.upper);
    }
    return checked(size, bins, measured, own);
  }

 private:
  EffectUse at(double strength) const {
    EffectUse use = shape_;
    use.values[row_] = strength;
    return use;
  }

  std::unique_ptr<Predictor> simulated(double strength, int replicate) const {
    const std::uint64_t seed =
        random_bits(search_.seed, stream_of("noise effect"), static_cast<std::uint64_t>(replicate));
    return search_.predictor->simulated(with_use(*search_.model, at(strength)), seed);
  }

  // Mean variances by bin of a simulated residual with this strength: [track, channel, bin].
  Eigen::VectorXd simulated(const Binning& bins, double strength) const {
    Eigen::VectorXd mean;
    for (int k = 0; k < kReplicates; ++k) {
      Eigen::VectorXd residual =
          simulated_residual(*simulated(strength, k), bins.residuals(), *search_.model, bins.predicted());
      if (residual.size() == 0) return residual;
      const Eigen::VectorXd e = bins.energies(residual).mean();
      mean = k == 0 ? e : Eigen::VectorXd(mean + e);
    }
    return mean / kReplicates;
  }

  static double most_likely(const Energies& measured, const Eigen::VectorXd& own, const Eigen::VectorXd& more,
                            double power, double size) {
    const Eigen::VectorXd energy = measured.mean(), weight = measured.weight();
    const auto unlikely = [&](double factor) {
      double sum = 0.0;
      for (Eigen::Index b = 0; b < own.size(); ++b) {
        const double expected = own[b] + more[b] * factor;
        if (weight[b] > 0.0 && expected > 0.0) sum += weight[b] * (energy[b] / expected + std::log(expected));
      }
      return sum;
    };
    double best = 0.0, least = unlikely(0.0);
    // (x / x_0)^a from 2^-40 to 2^20 in half octaves, then refined to 0.1 %.
    for (int k = -80; k <= 40; ++k) {
      const double factor = std::exp2(0.5 * k), value = unlikely(factor);
      if (value < least) least = value, best = factor;
    }
    for (double step = std::exp2(0.125); best > 0.0 && step > 1.001; step = std::sqrt(step)) {
      for (const double factor : {best * step, best / step}) {
        if (unlikely(factor) < least) least = unlikely(factor), best = factor;
      }
    }
    return best > 0.0 ? size * std::pow(best, 1.0 / power) : 0.0;
  }

  std::optional<NoiseEffect> checked(double strength, const Binning& fit_bins, const Energies& fit_measured,
                                     const Eigen::VectorXd& fit_own) const {
    const Splits& unweighted = *search_.unweighted;
    const WhitenedResiduals& tested =
        unweighted[kValidation].empty() ? unweighted[kTraining] : unweighted[kValidation];
    const bool same = unweighted[kValidation].empty();
    const Binning bins = same ? fit_bins : Binning(*search_.predictor, tested, *search_.model);
    if (bins.predicted().size() != tested.size()) return std::nullopt;
    const Eigen::VectorXd residual = tested.residual_of(bins.predicted());
    const Energies measured = same ? fit_measured : bins.energies(residual);
    const Eigen::VectorXd own = same ? fit_own : simulated(bins, 0.0), with = simulated(bins, strength);
    if (own.size() == 0 || with.size() == 0) return std::nullopt;
    double before = 0.0, after = 0.0, all = 0.0, floor = 0.0;
    const Eigen::VectorXd energy = measured.mean(), weight = measured.weight();
    for (Eigen::Index b = 0; b < own.size(); ++b) {
      // In units of the sensors' variance, so that every channel counts; at least a fifth of the channel's
      // mean, since counts at rest have none (tuned on the open cases; sensitivity not measured).
      const double unit = std::max(own[b], 0.2 * own.segment(b - b % kBins, kBins).mean());
      if (!(unit > 0.0)) continue;
      const double n = measured.count[b];
      before += weight[b] * std::pow((energy[b] - own[b]) / unit, 2);
      after += weight[b] * std::pow((energy[b] - with[b]) / unit, 2);
      all += n * (energy[b] - own[b]) / unit;
      floor += n;
    }
    NoiseEffect out{
        .use = at(strength), .strength = {}, .explained = before > 0.0 ? 1.0 - after / before : 0.0};
    if (all < kExcess * floor || out.explained < kExplained) return std::nullopt;
    // What else the law does (a counted speed is late by half its window) has to be there as well.
    const Eigen::VectorXd moved =
        tested.residual(tested.predicted_runs(with_use(*search_.model, at(strength)), 1));
    if (moved.size() != residual.size() || energy_ratio(tested, residual, moved) > 1.0 + kMostEnergyRise)
      return std::nullopt;
    const Eigen::VectorXd drawn =
        simulated_residual(*simulated(strength, kReplicates), tested, *search_.model, bins.predicted());
    if (drawn.size() == 0) return std::nullopt;
    const Eigen::VectorXd apart = autocorrelations(*search_.predictor, tested, residual) -
                                  autocorrelations(*search_.predictor, tested, drawn);
    // An autocorrelation from n samples has a standard error of 1 / sqrt(n) (Bartlett 1946), n the effective
    // sample size of the energy (Kish 1965); three of them are allowed.
    const auto finite = residual.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }).array();
    const double effective =
        std::pow(finite.square().sum(), 2) / std::max(finite.square().square().sum(), 1e-300);
    if (apart.cwiseAbs().maxCoeff() > kCorrelation + 3.0 / std::sqrt(effective)) return std::nullopt;
    const EffectParam& row = entry_.info->params[row_];
    out.strength.path = std::string(entry_.info->id) + "." + std::string(row.name);
    out.strength.unit = row.unit;
    out.strength.value = strength;
    // Relative standard error of a variance from n samples: sqrt(2 / n).
    out.strength.sigma = out.strength.data_sigma =
        strength * std::sqrt(2.0 / fit_measured.count.sum()) * (1.0 + floor / std::max(all, 1e-9));
    return out;
  }

  const NoiseSearch& search_;
  const EffectEntry& entry_;
  EffectUse shape_;
  std::size_t row_ = 0;
};

}  // namespace

std::optional<NoiseEffect> noise_effect(const NoiseSearch& search,
                                        const std::vector<const EffectEntry*>& effects) {
  std::vector<const EffectEntry*> tried;
  for (const EffectEntry* entry : effects) {
    int strengths = 0;
    for (const EffectParam& row : entry->info->params) strengths += row.role == ParamRole::kStrength ? 1 : 0;
    if ((entry->info->claims & kRandom) != 0 && strengths == 1) tried.push_back(entry);
  }
  std::vector<std::optional<NoiseEffect>> found(tried.size());
  parallel_for(static_cast<int>(tried.size()), [&](int n) {
    const auto k = static_cast<std::size_t>(n);
    found[k] = Trial(search, *tried[k]).run();
  });
  std::optional<NoiseEffect> best;
  for (std::optional<NoiseEffect>& f : found) {
    if (f && (!best || f->explained > best->explained)) best = std::move(f);
  }
  return best;
}

}  // namespace omnihil
