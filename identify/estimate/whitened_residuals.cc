#include "identify/estimate/whitened_residuals.h"

#include <algorithm>
#include <cmath>

#include "identify/record/parallel.h"
#include "sim/law/symmetric.h"

namespace omnihil {
namespace {

// A block is a few times the slowest autocorrelation of a drive's residual (mechanical time constants of 10
// to 200 ms), as a block bootstrap needs (Kuensch 1989), yet a recording of ten seconds still has twenty.
// Sensitivity not measured.
constexpr double kBlock_s = 0.5;        // a choice
constexpr int kMostBlocksPerRun = 200;  // of a longer run blocks grow: bounds the bootstrap's cost; a choice

constexpr const char* kBusVoltage = "bus_voltage";

// Subtracts from each column its least-squares parabola over the rows.
void remove_slow_trend(Eigen::MatrixXd& columns) {
  const Eigen::Index n = columns.rows();
  if (n < 6) return;
  Eigen::MatrixXd slow(n, 3);
  const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(n, -1.0, 1.0);
  slow << Eigen::VectorXd::Ones(n), x.matrix(), x.square().matrix();
  const Eigen::MatrixXd gram = slow.transpose() * slow;
  const Eigen::MatrixXd share = ldlt_solve_columns(gram, slow.transpose() * columns);
  columns -= slow * share;
}

int channel_of(const ComparedChannels& channels, const std::string& name) {
  return static_cast<int>(std::find(channels.name.begin(), channels.name.end(), name) -
                          channels.name.begin());
}

}  // namespace

ComparedChannels compared_channels(const Predictor& predictor) {
  ComparedChannels channels;
  std::vector<double> square, count;
  for (int run = 0; run < predictor.run_count(); ++run) {
    for (const ComparedSignal& s : predictor.compared(run)) {
      const std::size_t k = static_cast<std::size_t>(channel_of(channels, s.name));
      if (k == channels.name.size()) {
        channels.name.push_back(s.name);
        square.push_back(0.0);
        count.push_back(0.0);
      }
      const double sigma = s.whitening_s > 0.0 ? s.whitened_sigma : s.noise_sigma;
      square[k] += sigma * sigma;
      count[k] += 1.0;
    }
  }
  for (std::size_t k = 0; k < square.size(); ++k)
    channels.noise_sigma.push_back(std::sqrt(square[k] / count[k]));
  return channels;
}

WhitenedResiduals::WhitenedResiduals(const Predictor& predictor, const ComparedChannels& channels,
                                     Split split, Weighing weighing)
    : predictor_(&predictor), split_(split), weighing_(weighing), channels_(channels.count()) {
  for (int run = 0; run < predictor.run_count(); ++run) {
    if (predictor.run(run).split == split) add_run(run, channels);
  }
  measured_ = measured_by(predictor);
  samples_ = Eigen::VectorXd::Zero(channels_);
  block_samples_ = Eigen::MatrixXd::Zero(blocks_, channels_);
  for (const Part& part : parts_) {
    samples_[part.channel] += static_cast<double>(part.rows.size());
    for (const int block : part.time_block) block_samples_(block, part.channel) += 1.0;
  }
}

void WhitenedResiduals::add_run(int run, const ComparedChannels& channels) {
  const std::vector<ComparedSignal>& signals = predictor_->compared(run);
  runs_.push_back(run);
  int run_blocks = 0;
  for (std::size_t s = 0; s < signals.size(); ++s) {
    const ComparedSignal& signal = signals[s];
    Part part{.run = run,
              .signal = static_cast<int>(s),
              .channel = channel_of(channels, signal.name),
              .first = size_,
              .rows = {},
              .time_block = {}};
    const int rows = static_cast<int>(signal.measured.size());
    const double duration_s = rows > 1 ? signal.time_s.back() - signal.time_s.front() : 0.0;
    const int count = std::clamp(static_cast<int>(duration_s / kBlock_s), 1, kMostBlocksPerRun);
    run_blocks = std::max(run_blocks, count);
    for (int i = 0; i < rows; ++i) {
      if (!std::isfinite(signal.measured[static_cast<std::size_t>(i)])) continue;
      part.rows.push_back(i);
      const double share =
          duration_s > 0.0 ? (signal.time_s[static_cast<std::size_t>(i)] - signal.time_s.front()) / duration_s
                           : 0.0;
      part.time_block.push_back(blocks_ + std::min(count - 1, static_cast<int>(share * count)));
    }
    if (part.rows.empty()) continue;
    size_ += static_cast<Eigen::Index>(part.rows.size());
    parts_.push_back(std::move(part));
  }
  blocks_ += run_blocks;
}

void WhitenedResiduals::weigh(const ComparedSignal& signal, Eigen::MatrixXd& columns) const {
  if (weighing_ == Weighing::kWhitened)
    whiten(signal, columns);
  else
    average(signal, columns);
}

Eigen::MatrixXd WhitenedResiduals::whitened_rows(const Part& part, const Eigen::MatrixXd& rows) const {
  const ComparedSignal& signal = predictor_->compared(part.run)[static_cast<std::size_t>(part.signal)];
  Eigen::MatrixXd all = Eigen::MatrixXd::Constant(rows.rows(), rows.cols(), std::nan(""));
  for (const int row : part.rows) all.row(row) = rows.row(row);
  weigh(signal, all);
  Eigen::MatrixXd out(part.rows.size(), rows.cols());
  for (std::size_t i = 0; i < part.rows.size(); ++i)
    out.row(static_cast<Eigen::Index>(i)) = all.row(part.rows[i]);
  if (signal.name == kBusVoltage) remove_slow_trend(out);
  return out;
}

void WhitenedResiduals::whiten_part(const Part& part, Eigen::MatrixXd& columns) const {
  const ComparedSignal& signal = predictor_->compared(part.run)[static_cast<std::size_t>(part.signal)];
  if (signal.whitening_s <= 0.0) return;
  Eigen::MatrixXd all = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(signal.measured.size()),
                                                  columns.cols(), std::nan(""));
  for (std::size_t i = 0; i < part.rows.size(); ++i)
    all.row(part.rows[i]) = columns.row(static_cast<Eigen::Index>(i));
  weigh(signal, all);
  for (std::size_t i = 0; i < part.rows.size(); ++i)
    columns.row(static_cast<Eigen::Index>(i)) = all.row(part.rows[i]);
}

Eigen::VectorXd WhitenedResiduals::gathered(const std::vector<Prediction>& runs) const {
  Eigen::VectorXd out(size_);
  for (const Part& part : parts_) {
    const std::size_t run =
        static_cast<std::size_t>(std::find(runs_.begin(), runs_.end(), part.run) - runs_.begin());
    const std::vector<double>& from = runs[run].values[static_cast<std::size_t>(part.signal)];
    const Eigen::Map<const Eigen::MatrixXd> column(from.data(), static_cast<Eigen::Index>(from.size()), 1);
    out.segment(part.first, static_cast<Eigen::Index>(part.rows.size())) = whitened_rows(part, column);
  }
  return out;
}

Eigen::VectorXd WhitenedResiduals::measured_by(const Predictor& other) const {
  std::vector<Prediction> measured(runs_.size());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    for (const ComparedSignal& s : other.compared(runs_[r])) measured[r].values.push_back(s.measured);
  }
  return gathered(measured);
}

Eigen::VectorXd WhitenedResiduals::predicted(const Candidate& candidate, int jobs) const {
  return predicted_by(*predictor_, candidate, jobs);
}

Eigen::VectorXd WhitenedResiduals::predicted_by(const Predictor& predictor, const Candidate& candidate,
                                                int jobs) const {
  return gathered_if_finite(runs_by(predictor, candidate, jobs));
}

std::vector<Prediction> WhitenedResiduals::runs_by(const Predictor& predictor, const Candidate& candidate,
                                                   int jobs) const {
  std::vector<Prediction> out(runs_.size());
  parallel_for(jobs, static_cast<int>(runs_.size()), [&](int r) {
    out[static_cast<std::size_t>(r)] = predictor.predict(candidate, runs_[static_cast<std::size_t>(r)]);
  });
  return out;
}

Eigen::VectorXd WhitenedResiduals::gathered_if_finite(const std::vector<Prediction>& runs) const {
  if (!std::all_of(runs.begin(), runs.end(), [](const Prediction& p) { return p.finite; })) return {};
  Eigen::VectorXd out = gathered(runs);
  if (!out.allFinite()) return {};
  return out;
}

std::vector<Prediction> WhitenedResiduals::predicted_runs(const Candidate& candidate, int jobs) const {
  return runs_by(*predictor_, candidate, jobs);
}

Eigen::VectorXd WhitenedResiduals::residual(const std::vector<Prediction>& runs) const {
  const Eigen::VectorXd model = gathered_if_finite(runs);
  if (model.size() != size_) return {};
  return measured_ - model;
}

Eigen::VectorXd WhitenedResiduals::residual(const Candidate& candidate, int jobs) const {
  return residual(predicted_runs(candidate, jobs));
}

Eigen::MatrixXd WhitenedResiduals::derivatives(const Candidate& candidate, std::span<const Unknown> unknowns,
                                               int jobs) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size_, static_cast<Eigen::Index>(unknowns.size()));
  parallel_for(jobs, static_cast<int>(runs_.size()), [&](int r) {
    const int run = runs_[static_cast<std::size_t>(r)];
    const Prediction p = predictor_->predict_with_derivatives(candidate, unknowns, run);
    for (const Part& part : parts_) {
      if (part.run != run) continue;
      const Eigen::MatrixXd& from = p.derivatives[static_cast<std::size_t>(part.signal)];
      out.middleRows(part.first, static_cast<Eigen::Index>(part.rows.size())) = whitened_rows(part, from);
    }
  });
  return out.allFinite()
             ? out
             : Eigen::MatrixXd(out.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; }));
}

Eigen::VectorXd WhitenedResiduals::track(const Candidate& candidate, std::string_view name) const {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(size_, std::nan(""));
  for (const int run : runs_) {
    for (const RegimeTrack& track : predictor_->regimes(candidate, run)) {
      if (track.name != name) continue;
      for (const Part& part : parts_) {
        if (part.run != run) continue;
        for (std::size_t i = 0; i < part.rows.size(); ++i) {
          out[part.first + static_cast<Eigen::Index>(i)] =
              track.value[static_cast<std::size_t>(part.rows[i])];
        }
      }
    }
  }
  return out;
}

Eigen::VectorXd WhitenedResiduals::mean_square(const Eigen::VectorXd& residual) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(channels_);
  for (const Part& part : parts_) {
    out[part.channel] +=
        residual.segment(part.first, static_cast<Eigen::Index>(part.rows.size())).squaredNorm();
  }
  for (int k = 0; k < channels_; ++k) out[k] = samples_[k] > 0.0 ? out[k] / samples_[k] : 0.0;
  return out;
}

Eigen::VectorXd WhitenedResiduals::measured_variance() const {
  Eigen::VectorXd centred = measured_;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(channels_);
  for (const Part& part : parts_)
    sum[part.channel] += measured_.segment(part.first, static_cast<Eigen::Index>(part.rows.size())).sum();
  for (const Part& part : parts_)
    centred.segment(part.first, static_cast<Eigen::Index>(part.rows.size())).array() -=
        sum[part.channel] / samples_[part.channel];
  return mean_square(centred);
}

Eigen::MatrixXd WhitenedResiduals::block_sums(const Eigen::VectorXd& residual) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(blocks_, channels_);
  for (const Part& part : parts_) {
    for (std::size_t i = 0; i < part.rows.size(); ++i) {
      const double r = residual[part.first + static_cast<Eigen::Index>(i)];
      out(part.time_block[i], part.channel) += r * r;
    }
  }
  return out;
}

Eigen::VectorXd WhitenedResiduals::weights(const Eigen::VectorXd& scale_of_channel) const {
  Eigen::VectorXd out(size_);
  for (const Part& part : parts_) {
    const double scale = scale_of_channel[part.channel];
    out.segment(part.first, static_cast<Eigen::Index>(part.rows.size()))
        .setConstant(scale > 0.0 ? 1.0 / scale : 0.0);
  }
  return out;
}

}  // namespace omnihil
