#include "identify/estimate/residual_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace omnihil {
namespace {

constexpr std::size_t kShortest =
    16;  // samples of a part: two octaves; shorter ones are left as they are. A choice.
constexpr double kEnds = 0.02;  // of a part, whose mean is where its line begins and ends: a choice

using Spectrum = std::vector<std::complex<double>>;

// Smallest even length of factors 2, 3 and 5 that is not shorter: for the transform.
std::size_t fast_length(std::size_t n) {
  for (n += n % 2;; n += 2) {
    std::size_t rest = n;
    for (const std::size_t factor : {2u, 3u, 5u}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return n;
  }
}

// Less the straight line between the means of its ends, so that it goes on periodically without a step.
std::vector<double> without_line(const Eigen::Ref<const Eigen::VectorXd>& x) {
  const Eigen::Index n = x.size();
  const Eigen::Index ends =
      std::max<Eigen::Index>(1, static_cast<Eigen::Index>(kEnds * static_cast<double>(n)));
  const double first = x.head(ends).mean(), last = x.tail(ends).mean();
  const double span = static_cast<double>(n - ends);
  std::vector<double> out(fast_length(static_cast<std::size_t>(n)), 0.0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double share = (static_cast<double>(i) - 0.5 * static_cast<double>(ends - 1)) / span;
    out[static_cast<std::size_t>(i)] = x[i] - first - share * (last - first);
  }
  return out;
}

// Octave k: from half the rate over 2^(k + 1) to half the rate over 2^k.
int octave_of(double frequency) { return static_cast<int>(std::floor(-std::log2(2.0 * frequency))); }

}  // namespace

ResidualSpectrum::ResidualSpectrum(const WhitenedResiduals& residuals, const Eigen::VectorXd& residual)
    : octaves_(static_cast<std::size_t>(residuals.samples().size())) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Spectrum spectrum;
  for (const WhitenedResiduals::Part& part : residuals.parts()) {
    const auto n = static_cast<Eigen::Index>(part.rows.size());
    if (part.rows.size() < kShortest) continue;
    const std::vector<double> x = without_line(residual.segment(part.first, n));
    fft.fwd(spectrum, x);
    const double length = static_cast<double>(x.size()), filled = static_cast<double>(n) / length;
    for (std::size_t k = 1; k < spectrum.size(); ++k) {
      const double frequency = static_cast<double>(k) / length;
      Octave& o = octaves_[static_cast<std::size_t>(part.channel)][std::max(0, octave_of(frequency))];
      // Two real numbers a frequency, one at half the rate; of zeros appended none.
      const double numbers = 2 * k == x.size() ? 1.0 : 2.0;
      o.power += numbers * std::norm(spectrum[k]) / length;
      o.degrees += numbers * filled;
    }
  }
}

double ResidualSpectrum::gain(int channel, double frequency) const {
  const std::map<int, Octave>& octaves = octaves_[static_cast<std::size_t>(channel)];
  const double at = -std::log2(2.0 * frequency) - 0.5;  // whole at the octaves' middles
  const auto log_power = [](const Octave& o) { return std::log(std::max(o.power / o.degrees, 1e-300)); };
  const auto above = octaves.lower_bound(static_cast<int>(std::ceil(at)));
  if (above == octaves.end()) return std::exp(-0.5 * log_power(octaves.rbegin()->second));
  if (above == octaves.begin()) return std::exp(-0.5 * log_power(above->second));
  const auto below = std::prev(above);
  const double share = (at - below->first) / static_cast<double>(above->first - below->first);
  const double power = (1.0 - share) * log_power(below->second) + share * log_power(above->second);
  return std::exp(-0.5 * power);
}

void ResidualSpectrum::flatten(const WhitenedResiduals& residuals, Eigen::MatrixXd& columns) const {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  Spectrum spectrum;
  std::vector<double> x, gains;
  for (const WhitenedResiduals::Part& part : residuals.parts()) {
    const auto n = static_cast<Eigen::Index>(part.rows.size());
    const bool known = !octaves_[static_cast<std::size_t>(part.channel)].empty();
    if (part.rows.size() < kShortest || !known) continue;
    const std::size_t length = fast_length(part.rows.size());
    gains.assign(length / 2 + 1, 0.0);
    for (std::size_t k = 1; k < gains.size(); ++k)
      gains[k] = gain(part.channel, static_cast<double>(k) / static_cast<double>(length));
    for (Eigen::Index c = 0; c < columns.cols(); ++c) {
      x = without_line(columns.col(c).segment(part.first, n));
      fft.fwd(spectrum, x);
      for (std::size_t k = 0; k < gains.size(); ++k) spectrum[k] *= gains[k];
      fft.inv(x, spectrum, static_cast<Eigen::Index>(length));
      columns.col(c).segment(part.first, n) =
          Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())).head(n);
    }
  }
}

Eigen::VectorXd ResidualSpectrum::flattened(const WhitenedResiduals& residuals,
                                            const Eigen::VectorXd& residual) const {
  if (residual.size() != residuals.size()) return {};
  Eigen::MatrixXd column = residual;
  flatten(residuals, column);
  return column;
}

}  // namespace omnihil
