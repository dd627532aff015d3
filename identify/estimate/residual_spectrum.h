// The power of a residual by octave of frequency, and the filter that makes such a residual white: what it leaves are the
// innovations, the part that the residual's own past does not foretell.
//
//   const ResidualSpectrum spectrum(training, parent);     // whitened_residuals.h
//   spectrum.flatten(training, columns);                   // residuals, or signals that an effect would add, [n x c], in place
//
// A residual that is mostly slow (a friction that no law has) is so correlated that a thousand of its samples say as much as one:
// in its plain sum of squares a fast effect beside it does not show, however far above the sensors' noise. Weighed by the inverse
// of the residual's own spectrum every octave counts by its independent samples (generalised least squares; Whittle, Ark. Mat. 2,
// 1953; Ljung, System Identification, 2nd ed. 1999, sec. 7.2 and 14.3).
// Shapes: n samples of a split, m channels; the flattened residual that it was made of has mean square 1 in every octave, no unit.
// Validity: evenly spaced samples, one period for all runs. Cannot: weigh a burst and a steady tone of the same power apart; tell a
// trend that a run sees once (a straight line from a part's first samples to its last is taken away before).
#pragma once
#include <Eigen/Core>
#include <map>
#include <vector>

#include "identify/estimate/whitened_residuals.h"

namespace omnihil {

class ResidualSpectrum {
 public:
  ResidualSpectrum(const WhitenedResiduals& residuals, const Eigen::VectorXd& residual);

  // `columns`: of any split of the same predictor, n x c.
  void flatten(const WhitenedResiduals& residuals, Eigen::MatrixXd& columns) const;
  Eigen::VectorXd flattened(const WhitenedResiduals& residuals, const Eigen::VectorXd& residual) const;

 private:
  struct Octave {
    double power = 0.0,
           degrees = 0.0;  // summed over the runs: |X|^2 / n, and how many real numbers that is of
  };
  // 1 / sqrt of the power at a frequency, in cycles a sample; linear in the logarithms between the octaves' middles.
  double gain(int channel, double frequency) const;

  // [channel], by octaves below half the rate; a channel without samples has none.
  std::vector<std::map<int, Octave>> octaves_;
};

}  // namespace omnihil
