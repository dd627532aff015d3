#include "sim/field/chip_kick.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "ceres/tiny_solver.h"
#include "sim/law/random.h"

namespace omnihil {
namespace {

constexpr int kWeights = static_cast<int>(kChipHidden * 2 + kChipHidden + 2 * kChipHidden + 2);
using Weights = Eigen::Matrix<double, kWeights, 1>;

double to_unit(double x, double least, double most) {
  return std::clamp(2.0 * (x - least) / (most - least) - 1.0, -1.0, 1.0);
}
double from_unit(double x, double least, double most) { return least + 0.5 * (x + 1.0) * (most - least); }

// Each neuron of the first layer: two weights and a bias; then each output: its weights and its bias.
struct Layers {
  const double* w;
  double hidden(std::size_t n, const double* x) const {
    return std::tanh(w[3 * n] * x[0] + w[3 * n + 1] * x[1] + w[3 * n + 2]);
  }
  static constexpr std::size_t kFirst = 3 * kChipHidden, kPerOutput = kChipHidden + 1;
};

// Residuals of all points: outputs against the table, scaled; the derivative by back-propagation.
struct ChipResiduals {
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = kWeights };
  std::vector<std::array<double, 4>> points;  // x0, x1, wanted 0, 1
  int NumResiduals() const { return static_cast<int>(2 * points.size()); }
  bool operator()(const double* w, double* residuals, double* jacobian) const {
    const Layers layers{w};
    const auto rows = static_cast<Eigen::Index>(2 * points.size());
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kWeights>> j(jacobian, jacobian ? rows : 0, kWeights);
    if (jacobian) j.setZero();
    for (std::size_t p = 0; p < points.size(); ++p) {
      std::array<double, kChipHidden> h;
      for (std::size_t n = 0; n < kChipHidden; ++n) h[n] = layers.hidden(n, points[p].data());
      for (std::size_t o = 0; o < 2; ++o) {
        const std::size_t first = Layers::kFirst + o * Layers::kPerOutput;
        double out = w[first + kChipHidden];
        for (std::size_t n = 0; n < kChipHidden; ++n) out += w[first + n] * h[n];
        const auto row = static_cast<Eigen::Index>(2 * p + o);
        residuals[row] = out - points[p][2 + o];
        if (!jacobian) continue;
        for (std::size_t n = 0; n < kChipHidden; ++n) {
          const double back = w[first + n] * (1.0 - h[n] * h[n]);
          const auto at = static_cast<Eigen::Index>(3 * n);
          j(row, static_cast<Eigen::Index>(first + n)) = h[n];
          j(row, at) = back * points[p][0];
          j(row, at + 1) = back * points[p][1];
          j(row, at + 2) = back;
        }
        j(row, static_cast<Eigen::Index>(first + kChipHidden)) = 1.0;
      }
    }
    return true;
  }
};

void put(const Weights& w, ChipNetwork& out) {
  for (std::size_t n = 0; n < kChipHidden; ++n) {
    const auto at = static_cast<Eigen::Index>(3 * n);
    out.w1[n] = {w[at], w[at + 1]};
    out.b1[n] = w[at + 2];
  }
  for (std::size_t o = 0; o < 2; ++o) {
    const auto first = static_cast<Eigen::Index>(Layers::kFirst + o * Layers::kPerOutput);
    for (std::size_t n = 0; n < kChipHidden; ++n) out.w2[o][n] = w[first + static_cast<Eigen::Index>(n)];
    out.b2[o] = w[first + static_cast<Eigen::Index>(kChipHidden)];
  }
}

void take_ranges(std::span<const ChipPoint> table, ChipNetwork& out) {
  const auto range = [&](auto member, double& least, double& most) {
    const auto [low, high] = std::ranges::minmax(table, {}, member);
    least = low.*member;
    most = high.*member > least ? high.*member : least + 1.0;
  };
  range(&ChipPoint::k, out.in_least[0], out.in_most[0]);
  range(&ChipPoint::y_m, out.in_least[1], out.in_most[1]);
  range(&ChipPoint::speed_m_s, out.out_least[0], out.out_most[0]);
  range(&ChipPoint::angle_rad, out.out_least[1], out.out_most[1]);
}

}  // namespace

ChipKick chip_kick(const ChipNetwork& n, double k, double y_m) {
  const double x[2] = {to_unit(k, n.in_least[0], n.in_most[0]), to_unit(y_m, n.in_least[1], n.in_most[1])};
  double out[2] = {n.b2[0], n.b2[1]};
  for (std::size_t i = 0; i < kChipHidden; ++i) {
    const double h = std::tanh(n.w1[i][0] * x[0] + n.w1[i][1] * x[1] + n.b1[i]);
    out[0] += n.w2[0][i] * h;
    out[1] += n.w2[1][i] * h;
  }
  return {std::max(0.0, from_unit(out[0], n.out_least[0], n.out_most[0])),
          std::clamp(from_unit(out[1], n.out_least[1], n.out_most[1]), 0.0, 0.5 * std::numbers::pi)};
}

double chip_distance_m(const ChipKick& kick, double height_m, double clear_height_m) {
  const double up = kick.speed_m_s * std::sin(kick.angle_rad), g = kGravity_m_s2;
  const double above_m = height_m - clear_height_m, root = up * up + 2.0 * g * above_m;
  if (root < 0.0) return 0.0;  // never that high
  return kick.speed_m_s * std::cos(kick.angle_rad) * (up + std::sqrt(root)) / g;
}

double chip_apex_m(const ChipKick& kick) {
  const double up = kick.speed_m_s * std::sin(kick.angle_rad);
  return up * up / (2.0 * kGravity_m_s2);
}

ChipPoint ballistic_chip(double k, double y_m) {
  const double degree = std::numbers::pi / 180.0;
  return {k, y_m, 0.75 * k * (1.0 - (y_m / 0.06) * (y_m / 0.06)),
          degree * (45.0 - 0.6 * k - 5.0 * (y_m / 0.03) * (y_m / 0.03))};
}

ChipTraining train_chip(std::span<const ChipPoint> table, const ChipTrainingOptions& options) {
  if (2 * table.size() < kWeights) {
    throw std::invalid_argument("a chip table needs at least " + std::to_string(kWeights / 2) +
                                " points: the network has " + std::to_string(kWeights) + " weights");
  }
  ChipTraining best;
  ChipResiduals residuals;
  take_ranges(table, best.network);
  const ChipNetwork& n = best.network;
  for (const ChipPoint& p : table) {
    if (!std::isfinite(p.k) || !std::isfinite(p.y_m) || !std::isfinite(p.speed_m_s) ||
        !std::isfinite(p.angle_rad))
      throw std::invalid_argument("a chip table has finite numbers only");
    residuals.points.push_back({to_unit(p.k, n.in_least[0], n.in_most[0]),
                                to_unit(p.y_m, n.in_least[1], n.in_most[1]),
                                to_unit(p.speed_m_s, n.out_least[0], n.out_most[0]),
                                to_unit(p.angle_rad, n.out_least[1], n.out_most[1])});
  }
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < options.starts; ++start) {
    Weights w;
    for (Eigen::Index i = 0; i < kWeights; ++i)
      w[i] = 0.5 * gaussian(options.seed, static_cast<std::uint64_t>(start), static_cast<std::uint64_t>(i));
    ceres::TinySolver<ChipResiduals> solver;
    solver.options.max_num_iterations = options.most_iterations;
    solver.Solve(residuals, &w);
    if (!(solver.summary.final_cost < least)) continue;
    least = solver.summary.final_cost;
    best.iterations = solver.summary.iterations;
    put(w, best.network);
  }
  double speed2 = 0.0, angle2 = 0.0;
  for (const ChipPoint& p : table) {
    const ChipKick found = chip_kick(best.network, p.k, p.y_m);
    speed2 += (found.speed_m_s - p.speed_m_s) * (found.speed_m_s - p.speed_m_s);
    angle2 += (found.angle_rad - p.angle_rad) * (found.angle_rad - p.angle_rad);
  }
  best.speed_rms_m_s = std::sqrt(speed2 / static_cast<double>(table.size()));
  best.angle_rms_rad = std::sqrt(angle2 / static_cast<double>(table.size()));
  return best;
}

}  // namespace omnihil
