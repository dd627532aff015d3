// What the explanation of a difference computes with: runs of a recording with a changed model, their differences by the
// noise, and the statistics of blocks of time (explain_difference.h says the method and its sources).
//
//   ExplainSearch search(recording, format, options);
//   const Trajectories base = search.run(model);
//   search.weigh_by(base);
//   const Weighted r = search.residual(base);
#pragma once
#include <vector>

#include "hil/check/measured_series.h"
#include "hil/recording/replay_run.h"
#include "protocols/radio_format.h"

namespace omnihil {

inline constexpr std::size_t kExplainBlocks =
    10;  // Künsch 1989: few long blocks, each longer than the loop's memory
// Two-sided 5 % of Student's t with one degree of freedom less: a size +- this many standard errors is its 95 %.
inline constexpr double kExplainT = 2.262;

// The differences of all series in one vector, already by their noise, with each one's block of time.
struct Weighted {
  std::vector<double> r;
  std::vector<std::size_t> block;
};

using Trajectories = std::vector<std::vector<double>>;  // series by series, at the measured times

class ExplainSearch {
 public:
  // All three outlive it.
  ExplainSearch(const Recording& recording, const RadioFormat& format, const ReplayOptions& options);

  const std::vector<MeasuredSeries>& measured() const { return measured_; }
  // The model's values of every series at the measured times; `chance` 0: with the seed of the options, else another.
  Trajectories run(const ModelBundle& model, std::uint64_t chance = 0) const;
  // The noise of each series, from its difference to the model as it stands.
  void weigh_by(const Trajectories& base);
  // measured - values, by the noise.
  Weighted residual(const Trajectories& values) const;
  // (moved - values) by the noise, over `step`.
  Weighted sensitivity(const Trajectories& moved, const Trajectories& values, double step) const;

 private:
  Weighted by_noise(const Trajectories& a, const Trajectories& b, double step) const;

  const Recording& recording_;
  const RadioFormat& format_;
  const ReplayOptions& options_;
  MeasuredBy by_;
  std::vector<MeasuredSeries> measured_;
  std::vector<double> sigma_;
  double end_s_ = 1e-9;
};

double dot(const std::vector<double>& a, const std::vector<double>& b);
double rms(const std::vector<double>& x);
double sum_of(const std::vector<double>& values);
std::vector<double> block_errors(const Weighted& w);
// Paired t of the blocks: `a` has the smaller error.
bool better(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace omnihil
