#include "hil/check/explain_size.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace omnihil {
namespace {

// A choice: the runs' chance is a third of one's then, and the six candidates of a search cost as much as a third of it.
constexpr std::size_t kAround = 8;
constexpr int kRounds = 4;         // a choice: a start that is further off than eight half widths is none
constexpr double kFurthest = 2.0;  // half widths: further out the line is not to be trusted

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

// Places and, block by block, what the instruments say of the run there.
struct Runs {
  Matrix at;                 // kAround x candidates
  std::vector<Matrix> said;  // of each block: kAround x candidates
};

// The plane through all blocks but one (kExplainBlocks: through all): said = mean + slope (at - middle).
struct Plane {
  Vector middle, mean;
  Matrix slope;
};
Plane plane_of(const Matrix& at, const Matrix& said) {
  const Vector middle = at.colwise().mean(), mean = said.colwise().mean();
  const Matrix off = at.rowwise() - middle.transpose();
  return {middle, mean, (off.transpose() * off).ldlt().solve(off.transpose() * said).transpose()};
}
Plane plane_of(const Runs& runs, std::size_t without) {
  Matrix said = Matrix::Zero(runs.at.rows(), runs.at.cols());
  for (std::size_t b = 0; b < kExplainBlocks; ++b)
    if (b != without) said += runs.said[b];
  return plane_of(runs.at, said);
}

std::optional<Vector> root(const Runs& runs, std::size_t without) {
  const Plane plane = plane_of(runs, without);
  const Eigen::FullPivLU<Matrix> lu(plane.slope);
  if (!lu.isInvertible()) return std::nullopt;
  Vector found = plane.middle - lu.solve(plane.mean);
  return found.allFinite() ? std::optional(found) : std::nullopt;
}

// Variances of the sizes by what one run's chance does to all blocks alike (a heading that is off stays off), which no
// block shows by itself: the scatter of whole runs round the plane less what the scatter of their blocks makes of it.
Vector lasting_variance(const Runs& runs) {
  const auto n = runs.at.cols(), count = runs.at.rows();
  const Eigen::FullPivLU<Matrix> lu(plane_of(runs, kExplainBlocks).slope);
  constexpr double blocks = kExplainBlocks;
  Matrix whole = Matrix::Zero(count, n), squares = Matrix::Zero(count, n);
  for (const Matrix& said : runs.said) {
    const Plane plane = plane_of(runs.at, said);
    const Matrix line = (runs.at.rowwise() - plane.middle.transpose()) * plane.slope.transpose();
    const Matrix off = (said - line).rowwise() - plane.mean.transpose();
    const Matrix size = lu.solve(off.transpose()).transpose();
    whole += size;
    squares += size.cwiseAbs2();
  }
  const Matrix by_blocks = (squares - whole.cwiseAbs2() / blocks) * (blocks / (blocks - 1.0));
  const Vector excess = (whole.cwiseAbs2() - by_blocks).colwise().sum() / static_cast<double>(count - 1 - n);
  // Once in the measured run, and in the mean of the model's.
  return excess.cwiseMax(0.0) * (1.0 + 1.0 / static_cast<double>(count));
}

// Round the start: on a circle of the half widths, so that two candidates are moved each by itself; kept within bounds.
std::optional<Runs> runs_round(const ExplainSearch& search, const SizeQuestion& q) {
  const auto n = static_cast<Eigen::Index>(q.start.size());
  Runs runs{Matrix(kAround, n), std::vector<Matrix>(kExplainBlocks, Matrix::Zero(kAround, n))};
  for (std::size_t k = 0; k < kAround; ++k) {
    const double angle_rad = 2.0 * std::numbers::pi * static_cast<double>(k) / double{kAround};
    std::vector<double> at(q.start.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double share = i == 0 ? std::cos(angle_rad) : std::sin(angle_rad);
      at[i] = std::clamp(q.start[i] + share * q.half[i], q.lower[i], q.upper[i]);
      runs.at(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = at[i];
    }
    const auto model = q.model(at);
    if (!model) return std::nullopt;
    try {
      const Weighted r = search.residual(search.run(*model, k + 1));
      for (std::size_t i = 0; i < q.z.size(); ++i)
        for (std::size_t m = 0; m < r.r.size(); ++m)
          runs.said[r.block[m]](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) +=
              q.z[i]->r[m] * r.r[m];
    } catch (const std::runtime_error&) {
      return std::nullopt;  // the state stopped being finite there
    }
  }
  return runs;
}

}  // namespace

std::optional<SizeFit> fitted_sizes(const ExplainSearch& search, const SizeQuestion& question) {
  SizeQuestion q = question;
  std::optional<Runs> runs;
  std::optional<Vector> found;
  // A start that was off: again round where the line points to, at most twice the half widths further.
  bool inside = false;
  for (int round = 0; round < kRounds && !inside; ++round) {
    runs = runs_round(search, q);
    found = runs ? root(*runs, kExplainBlocks) : std::nullopt;
    if (!found) return std::nullopt;
    inside = true;
    for (std::size_t i = 0; i < q.start.size(); ++i) {
      const double value = (*found)(static_cast<Eigen::Index>(i)), furthest = kFurthest * q.half[i];
      inside = inside && std::abs(value - q.start[i]) <= q.half[i];
      q.start[i] =
          std::clamp(std::clamp(value, q.start[i] - furthest, q.start[i] + furthest), q.lower[i], q.upper[i]);
    }
  }
  if (!inside) return std::nullopt;
  SizeFit fit{q.start, {}};
  std::vector<Vector> without;
  for (std::size_t b = 0; b < kExplainBlocks; ++b) {
    const auto one = root(*runs, b);
    if (!one) return std::nullopt;  // a block alone tells it
    without.push_back(*one);
  }
  const Vector lasting = lasting_variance(*runs);
  constexpr double n = kExplainBlocks;
  for (Eigen::Index i = 0; i < found->size(); ++i) {
    double mean = 0.0, square = 0.0;
    for (const Vector& each : without) mean += each(i) / n;
    for (const Vector& each : without) square += (each(i) - mean) * (each(i) - mean);
    fit.sigma.push_back(std::sqrt(square * (n - 1.0) / n + lasting(i)));
  }
  return fit;
}

}  // namespace omnihil
