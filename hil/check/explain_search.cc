#include "hil/check/explain_search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace omnihil {
namespace {

constexpr double kLeastNoise = 1e-4;  // of a series' RMS: 13 bits of a converter; less is no sensor

// White noise from second differences: the variance of x[i-1] - 2 x[i] + x[i+1] is 6 sigma^2. Steps of a slow signal
// and single peaks count in full: a series that has them weighs less.
double white_noise(const std::vector<double>& x) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) sum += std::pow(x[i - 1] - 2.0 * x[i] + x[i + 1], 2);
  return x.size() < 3 ? 0.0 : std::sqrt(sum / (6.0 * static_cast<double>(x.size() - 2)));
}

// Resolution of a series: of its field, or the least step between two values.
double quantum(const MeasuredSeries& series) {
  double least = 0.0;
  for (std::size_t i = 1; i < series.value.size(); ++i) {
    const double step = std::abs(series.value[i] - series.value[i - 1]);
    if (step > 0.0 && (least == 0.0 || step < least)) least = step;
  }
  return std::max(series.step, least);
}

}  // namespace

ExplainSearch::ExplainSearch(const Recording& recording, const RadioFormat& format,
                             const ReplayOptions& options)
    : recording_(recording),
      format_(format),
      options_(options),
      by_(measured_by(recording)),
      measured_(measured_series(recording, format, by_)) {
  for (const MeasuredSeries& series : measured_) end_s_ = std::max(end_s_, series.time_s.back());
}

Trajectories ExplainSearch::run(const ModelBundle& model, std::uint64_t chance) const {
  ReplayOptions options = options_;
  options.model = model;
  if (chance != 0) options.seed = options.seed.value_or(recording_.header.seed) + chance;
  const ReplayRun run = run_again(recording_, options);
  if (!run.firmware_failure.empty()) throw std::runtime_error(run.firmware_failure);
  const std::vector<MeasuredSeries> answer = measured_series(run.answer, format_, by_);
  Trajectories values;
  for (const MeasuredSeries& series : measured_) {
    const auto same = std::ranges::find_if(answer, [&](const MeasuredSeries& other) {
      return other.name == series.name && other.robot_id == series.robot_id;
    });
    values.push_back(same == answer.end() ? std::vector<double>(series.time_s.size(), std::nan(""))
                                          : values_at(*same, series.time_s));
  }
  return values;
}

void ExplainSearch::weigh_by(const Trajectories& base) {
  sigma_.clear();
  for (std::size_t s = 0; s < measured_.size(); ++s) {
    std::vector<double> difference;
    for (std::size_t i = 0; i < base[s].size(); ++i) {
      const double d = measured_[s].value[i] - base[s][i];
      if (std::isfinite(d)) difference.push_back(d);
    }
    sigma_.push_back(std::max({white_noise(difference), quantum(measured_[s]) / std::sqrt(12.0),
                               kLeastNoise * rms(measured_[s].value), 1e-12}));
  }
}

Weighted ExplainSearch::residual(const Trajectories& values) const {
  Trajectories measured;
  for (const MeasuredSeries& series : measured_) measured.push_back(series.value);
  return by_noise(measured, values, 1.0);
}

Weighted ExplainSearch::sensitivity(const Trajectories& moved, const Trajectories& values,
                                    double step) const {
  return by_noise(moved, values, step);
}

Weighted ExplainSearch::by_noise(const Trajectories& a, const Trajectories& b, double step) const {
  Weighted out;
  for (std::size_t s = 0; s < measured_.size(); ++s) {
    for (std::size_t i = 0; i < measured_[s].value.size(); ++i) {
      // What one run has no value for counts as no difference: the places of all runs are the same.
      const double difference = a[s][i] - b[s][i];
      out.r.push_back(std::isfinite(difference) ? difference / (sigma_[s] * step) : 0.0);
      const double place = measured_[s].time_s[i] / end_s_ * double{kExplainBlocks};
      out.block.push_back(std::min(kExplainBlocks - 1, static_cast<std::size_t>(place)));
    }
  }
  return out;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

std::vector<double> block_errors(const Weighted& w) {
  std::vector<double> error(kExplainBlocks);
  for (std::size_t i = 0; i < w.r.size(); ++i) error[w.block[i]] += w.r[i] * w.r[i];
  return error;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum;
}

bool better(const std::vector<double>& a, const std::vector<double>& b) {
  double mean = 0.0, square = 0.0;
  for (std::size_t k = 0; k < kExplainBlocks; ++k) mean += (b[k] - a[k]) / kExplainBlocks;
  for (std::size_t k = 0; k < kExplainBlocks; ++k) square += std::pow(b[k] - a[k] - mean, 2);
  const double error = std::sqrt(square / (kExplainBlocks - 1) / kExplainBlocks);
  return mean > kExplainT * error;
}

double rms(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v * v;
  return x.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(x.size()));
}

}  // namespace omnihil
