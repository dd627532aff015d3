#include "identify/tyre/tyre_curve_fit.h"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "identify/record/statistics.h"

namespace omnihil {
namespace {

constexpr double kHuber = 2.0;                               // sigmas; a choice
constexpr double kLawShare = 0.02;                           // of the largest ratio, see the header; a choice
constexpr int kRounds = 40;                                  // by cost
constexpr double kStarts[] = {0.003, 0.01, 0.03, 0.1, 0.3};  // of the extremum's slip; a choice
constexpr double kSticks = 0.02;  // of slip, beside three sigmas (sticking_grip()); a choice

// (log slip, log value, log (asymptote's slip / extremum's - 1), logit (asymptote's value / extremum's))
TyreCurve curve_of(const Eigen::Vector4d& x) {
  TyreCurve c;
  c.extremum_slip = std::exp(x(0));
  c.extremum_value = std::exp(x(1));
  c.asymptote_slip = c.extremum_slip * (1.0 + std::exp(x(2)));
  c.asymptote_value = c.extremum_value / (1.0 + std::exp(-x(3)));
  return c;
}

// Slips are at most 2, and 2 is that of a wheel that turns against its motion; a model file allows a grip of 5.
const Eigen::Vector4d kLeast(-12.0, -6.0, -3.0, -6.0), kMost(0.0, 1.6, 3.0, 6.0);

struct Problem {
  std::span<const TyrePoint> points;
  std::vector<double> weight;  // 1 / sigma of the iteration before

  void weigh(const TyreCurve& c, double law) {
    weight.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const TyrePoint& p = points[i];
      const double h = std::max(1e-4, 0.1 * p.slip_sigma);
      const double slope = (grip<double>(c, p.slip + h) - grip<double>(c, p.slip - h)) / (2.0 * h);
      weight[i] = 1.0 / std::sqrt(p.ratio_sigma * p.ratio_sigma +
                                  slope * slope * p.slip_sigma * p.slip_sigma + law * law);
    }
  }
  // Residuals with Huber's weight in them: its square is the loss.
  Eigen::VectorXd residuals(const TyreCurve& c) const {
    Eigen::VectorXd r(static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double e = weight[i] * (points[i].ratio - grip<double>(c, points[i].slip));
      const double size = std::abs(e);
      r(static_cast<Eigen::Index>(i)) =
          size <= kHuber ? e : std::copysign(std::sqrt(2.0 * kHuber * size - kHuber * kHuber), e);
    }
    return r;
  }
};

// Levenberg-Marquardt by differences: four numbers, and a start that may be far.
double descend(Problem& problem, double law, Eigen::Vector4d& x) {
  double damping = 1e-2;
  problem.weigh(curve_of(x), law);
  Eigen::VectorXd r = problem.residuals(curve_of(x));
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd j(r.size(), 4);
    for (int k = 0; k < 4; ++k) {
      Eigen::Vector4d moved = x;
      moved(k) += 1e-4;
      j.col(k) = (problem.residuals(curve_of(moved)) - r) / 1e-4;
    }
    const Eigen::Matrix4d normal = j.transpose() * j;
    const Eigen::Vector4d right = -j.transpose() * r;
    bool better = false;
    for (int tries = 0; tries < 8 && !better; ++tries) {
      Eigen::Matrix4d damped = normal;
      for (int k = 0; k < 4; ++k) damped(k, k) += damping * (normal(k, k) + 1e-9);
      Eigen::Vector4d step = damped.colPivHouseholderQr().solve(right);
      if (step.norm() > 1.0) step *= 1.0 / step.norm();
      const Eigen::Vector4d next = (x + step).cwiseMax(kLeast).cwiseMin(kMost);
      const Eigen::VectorXd changed = problem.residuals(curve_of(next));
      better = changed.squaredNorm() < r.squaredNorm();
      if (better) {
        x = next;
        damping = std::max(1e-9, 0.3 * damping);
      } else {
        damping *= 5.0;
      }
    }
    problem.weigh(curve_of(x), law);
    const double before = r.squaredNorm();
    r = problem.residuals(curve_of(x));
    if (!better || std::abs(before - r.squaredNorm()) < 1e-8 * before) break;
  }
  return r.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, r.size()));
}

double largest_ratio(std::span<const TyrePoint> points) {
  std::vector<double> sizes;
  sizes.reserve(points.size());
  for (const TyrePoint& p : points) sizes.push_back(std::abs(p.ratio));
  return quantile(std::move(sizes), 0.99, QuantileRank::kLower);
}

}  // namespace

TyreCurveFit fit_tyre_curve(std::span<const TyrePoint> points) {
  TyreCurveFit best;
  best.chi2_per_point = std::numeric_limits<double>::infinity();
  const double most = std::max(1e-3, largest_ratio(points));
  Problem problem{points, {}};
  for (const double start : kStarts) {
    Eigen::Vector4d x(std::log(start), std::log(most), std::log(3.0), 1.0);
    const double chi2 = descend(problem, kLawShare * most, x);
    if (chi2 < best.chi2_per_point) best = {curve_of(x), chi2};
  }
  return best;
}

StickingGrip sticking_grip(const TyrePoints& points) {
  StickingGrip out;
  std::vector<const TyrePoint*> stick;
  for (const TyrePoint& p : points.all)
    if (std::abs(p.slip) < std::max(kSticks, 3.0 * p.slip_sigma)) stick.push_back(&p);
  if (stick.empty()) return out;
  std::ranges::sort(stick, std::greater<>{}, [](const TyrePoint* p) { return std::abs(p->ratio); });
  // A few, since noise pulls the largest single one up, and few, since a wheel is at its largest grip for an instant.
  const std::size_t count = std::min(stick.size(), std::max<std::size_t>(10, stick.size() / 500));
  double ratio = 0.0, slip = 0.0, slip2 = 0.0, noise2 = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const TyrePoint& p = *stick[i];
    ratio += std::abs(p.ratio);
    const double along = p.ratio > 0.0 ? p.slip : -p.slip;
    slip += along;
    slip2 += along * along;
    noise2 += p.slip_sigma * p.slip_sigma;
  }
  const double n = static_cast<double>(count);
  out.points = static_cast<int>(count);
  out.most_ratio = ratio / n;
  const double scatter2 = std::max(0.0, slip2 / n - slip * slip / (n * n));
  // Points of one push share their errors: counted as if five independent ones were in ten.
  const double error2 = std::max(scatter2, noise2 / n) / std::max(1.0, n / 2.0);
  const double radius = points.radius_m > 0.0 ? points.radius_sigma_m / points.radius_m : 0.0;
  out.slip_bound_95 = std::max(0.0, slip / n) + 1.645 * std::sqrt(error2 + radius * radius);
  return out;
}

std::vector<TyreBin> tyre_bins(std::span<const TyrePoint> points, int per_side) {
  std::vector<TyreBin> bins;
  if (points.empty()) return bins;
  // As many points in each bin on either side of zero.
  for (const int side : {-1, 1}) {
    std::vector<const TyrePoint*> mine;
    for (const TyrePoint& p : points)
      if ((p.slip < 0.0) == (side < 0)) mine.push_back(&p);
    std::ranges::sort(mine, {}, &TyrePoint::slip);
    const std::size_t count = mine.size() / static_cast<std::size_t>(per_side);
    if (count < 3) continue;
    for (std::size_t from = 0; from + count <= mine.size(); from += count) {
      TyreBin bin;
      double sum2 = 0.0;
      for (std::size_t i = from; i < from + count; ++i) {
        bin.slip += mine[i]->slip;
        bin.ratio += mine[i]->ratio;
        sum2 += mine[i]->ratio * mine[i]->ratio;
      }
      const double n = static_cast<double>(count);
      bin.slip /= n;
      bin.ratio /= n;
      bin.ratio_error = std::sqrt(std::max(0.0, sum2 / n - bin.ratio * bin.ratio) / (n - 1.0));
      bin.points = static_cast<int>(count);
      bins.push_back(bin);
    }
  }
  return bins;
}

}  // namespace omnihil
