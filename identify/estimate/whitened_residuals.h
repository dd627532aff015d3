// Measured minus predicted, all runs of one use as one long vector: what screening, refits and verdicts count
// with.
//
//   ComparedChannels kinds = compared_channels(predictor);             // velocity, motor_current, …
//   WhitenedResiduals fit(predictor, kinds, Split::kTraining);
//   Eigen::VectorXd r = fit.residual(candidate);             // empty: a run diverged
//   fit.mean_square(r)[0];                                   // of the first kind of signal
//   fit.block_sums(r);                                       // the same in blocks of time, for a bootstrap
//
// Only samples that were measured are in it, whitened (predictor.h), so that sums of squares mean something.
// Of a measured bus voltage the slow course of the battery (a parabola per run) is left out: the model is
// given it. Residuals are autocorrelated: blocks of time, not samples, are what may be drawn at random.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

// The signals of a dataset over all its runs, in the order in which they first appear.
struct ComparedChannels {
  std::vector<std::string> name;
  std::vector<double> noise_sigma;  // of the whitened residual; root mean square over the runs
  int count() const { return static_cast<int>(name.size()); }
};
ComparedChannels compared_channels(const Predictor& predictor);

// How residuals enter: whitened, so that sums of squares are likelihoods (what decides), or as they are seen
// (how large an error is to somebody who looks at the signal).
enum class Weighing : std::uint8_t { kWhitened, kUnweighted };

class WhitenedResiduals {
 public:
  struct Part {  // one signal of one run
    int run = 0;
    int signal = 0;  // in Predictor::compared(run)
    int channel = 0;
    Eigen::Index first = 0;       // of the long vector
    std::vector<int> rows;        // samples of the run
    std::vector<int> time_block;  // per row: which block of time
  };

  WhitenedResiduals(const Predictor& predictor, const ComparedChannels& channels, Split split,
                    Weighing weighing = Weighing::kWhitened);

  bool empty() const { return size_ == 0; }
  Eigen::Index size() const { return size_; }
  Split split() const { return split_; }
  const std::vector<Part>& parts() const { return parts_; }
  const std::vector<int>& runs() const { return runs_; }
  int blocks() const { return blocks_; }

  // The candidate's prediction; empty when a run of it stopped being finite.
  Eigen::VectorXd predicted(const Candidate& candidate, int jobs = 1) const;
  Eigen::VectorXd residual(const Candidate& candidate, int jobs = 1) const;
  Eigen::VectorXd residual_of(const Eigen::VectorXd& predicted) const { return measured_ - predicted; }
  Eigen::MatrixXd derivatives(const Candidate& candidate, std::span<const Unknown> unknowns, int jobs) const;
  // The same by another predictor of the same dataset.
  Eigen::VectorXd predicted_by(const Predictor& predictor, const Candidate& candidate, int jobs = 1) const;
  // What another predictor of the same dataset has measured, in this order (NaN: it has not).
  Eigen::VectorXd measured_by(const Predictor& other) const;

  // A signal's record over one part's own rows (as predicted: not whitened), whitened in place.
  void whiten_part(const Part& part, Eigen::MatrixXd& columns) const;

  // A track of the runs' regimes, sample by sample; NaN where a run does not have it.
  Eigen::VectorXd track(const Candidate& candidate, std::string_view name) const;

  // per kind; 0 where there are no samples
  Eigen::VectorXd mean_square(const Eigen::VectorXd& residual) const;
  const Eigen::VectorXd& samples() const { return samples_; }
  // [block, kind]: sums of squares, and numbers of samples
  Eigen::MatrixXd block_sums(const Eigen::VectorXd& residual) const;
  const Eigen::MatrixXd& block_samples() const { return block_samples_; }
  // 1 / scale of each sample's kind
  Eigen::VectorXd weights(const Eigen::VectorXd& scale_of_channel) const;

 private:
  void add_run(int run, const ComparedChannels& channels);
  // Whitened; `values`: per run of this use, per signal, per row.
  Eigen::VectorXd gathered(const std::vector<std::vector<std::vector<double>>>& values) const;
  // Rows of the part, whitened; `rows`: all rows of its run.
  Eigen::MatrixXd whitened_rows(const Part& part, const Eigen::MatrixXd& rows) const;

  const Predictor* predictor_;
  Split split_;
  Weighing weighing_;
  std::vector<int> runs_;
  std::vector<Part> parts_;
  Eigen::Index size_ = 0;
  int channels_ = 0;
  int blocks_ = 0;
  Eigen::VectorXd measured_;
  Eigen::VectorXd samples_;
  Eigen::MatrixXd block_samples_;
};

}  // namespace omnihil
