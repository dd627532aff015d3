// Whitened residuals, measured minus predicted: all runs of one split as one long vector, on which screening,
// refits and verdicts are computed.
//
//   ComparedChannels channels = compared_channels(predictor);   // velocity, motor_current, …
//   WhitenedResiduals training(predictor, channels, Split::kTraining);
//   Eigen::VectorXd r = training.residual(candidate);           // empty: a run diverged
//   training.mean_square(r)[0];                                 // of the first channel
//   training.block_sums(r);                                     // the same by blocks of time
//
// Shapes: n samples of all runs and channels of the split, one part (a signal of a run) after another; m
// channels; B blocks of time; p unknowns. A sample has its signal's unit (a whitened speed of counts: the
// position's). Only samples that were measured are in it, whitened (predictor.h), so that a sum of squares
// over the noise is a log-likelihood. From a measured bus voltage the battery's slow trend (a parabola per
// run) is removed: it is the model's input. Residuals are autocorrelated: blocks of time, not samples, are
// the units of resampling.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "identify/predict/predictor.h"

namespace omnihil {

// The m distinct signals that are compared in any run, in the order in which they first appear.
struct ComparedChannels {
  std::vector<std::string> name;
  std::vector<double> noise_sigma;  // of the whitened residual; root mean square over the runs
  int count() const { return static_cast<int>(name.size()); }
};
ComparedChannels compared_channels(const Predictor& predictor);

// Whitened, so that sums of squares are log-likelihoods (they decide), or unweighted: the plain error of the
// signal, as a plot shows it (predictor.h, averaged()).
enum class Weighing : std::uint8_t { kWhitened, kUnweighted };

class WhitenedResiduals {
 public:
  struct Part {  // one signal of one run
    int run = 0;
    int signal = 0;  // in Predictor::compared(run)
    int channel = 0;
    Eigen::Index first = 0;       // index in the long vector
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

  // Size n: the candidate's prediction, whitened like the measurement; empty when a run of it diverged.
  Eigen::VectorXd predicted(const Candidate& candidate, int jobs = 1) const;
  Eigen::VectorXd residual(const Candidate& candidate, int jobs = 1) const;
  // The same of predictions that were made before, one a run of predicted_runs(): for a second weighing of the same split.
  std::vector<Prediction> predicted_runs(const Candidate& candidate, int jobs = 1) const;
  Eigen::VectorXd residual(const std::vector<Prediction>& runs) const;
  Eigen::VectorXd residual_of(const Eigen::VectorXd& predicted) const { return measured_ - predicted; }
  // n x p: of the prediction, after the unknowns in their own units; not finite: 0.
  Eigen::MatrixXd derivatives(const Candidate& candidate, std::span<const Unknown> unknowns, int jobs) const;
  // Size n: the prediction by another predictor of the same dataset.
  Eigen::VectorXd predicted_by(const Predictor& predictor, const Candidate& candidate, int jobs = 1) const;
  // Size n: the measurement of another predictor of the same dataset, in this order (NaN: missing there).
  Eigen::VectorXd measured_by(const Predictor& other) const;

  // Whitens in place: [part.rows.size() x any] columns of one part.
  void whiten_part(const Part& part, Eigen::MatrixXd& columns) const;

  // Size n: a regime variable (RegimeTrack), in its own unit; NaN where a run does not have it.
  Eigen::VectorXd track(const Candidate& candidate, std::string_view name) const;

  // Size m: mean square per channel, in its unit squared; 0 where there are no samples.
  Eigen::VectorXd mean_square(const Eigen::VectorXd& residual) const;
  Eigen::VectorXd measured_variance() const;                   // the same of the measurement about its mean
  const Eigen::VectorXd& samples() const { return samples_; }  // size m: count per channel
  // B x m: sums of squares, and counts of samples.
  Eigen::MatrixXd block_sums(const Eigen::VectorXd& residual) const;
  const Eigen::MatrixXd& block_samples() const { return block_samples_; }
  // Size n: 1 / scale of each sample's channel (`scale_of_channel`: size m, its unit); 0 for a scale of 0.
  Eigen::VectorXd weights(const Eigen::VectorXd& scale_of_channel) const;

 private:
  void add_run(int run, const ComparedChannels& channels);
  void weigh(const ComparedSignal& signal, Eigen::MatrixXd& columns) const;  // whitens or averages, in place
  // Whitened, size n, of one prediction a run of this split.
  Eigen::VectorXd gathered(const std::vector<Prediction>& runs) const;
  std::vector<Prediction> runs_by(const Predictor& predictor, const Candidate& candidate, int jobs) const;
  Eigen::VectorXd gathered_if_finite(const std::vector<Prediction>& runs) const;  // empty: one is not
  // [part.rows.size() x c]: the part's rows of [rows of the run x c], whitened.
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
