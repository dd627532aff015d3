#include "identify/compare/order_spectrum.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "identify/record/statistics.h"
#include "sim/law/drive_params.h"
#include "sim/law/symmetric.h"

namespace omnihil {
namespace {

constexpr int kHighestOrder = 200;  // periods per turn; cogging of 14 poles and 12 slots has 84; a choice
constexpr double kFastest_rad =
    2.0;  // phase per sample, 2/3 of Nyquist's pi: a faster order is not resolved; a choice
constexpr double kStandsOut = 8.0;  // times the median over all orders; tuned, sensitivity not measured
// Of the residual's energy; a third of what an effect has to take.
constexpr double kLeastShare = 0.01;  // a choice

// Sine and cosine of one order after another, by the recurrence s(n+1) = 2 cos(x) s(n) - s(n-1).
struct Angles {
  Eigen::ArrayXd twice_cos, sin_n, cos_n, sin_before, cos_before;
  explicit Angles(const Eigen::ArrayXd& theta)
      : twice_cos(2.0 * theta.cos()),
        sin_n(theta.sin()),
        cos_n(theta.cos()),
        sin_before(Eigen::ArrayXd::Zero(theta.size())),
        cos_before(Eigen::ArrayXd::Ones(theta.size())) {}
  void next() {
    Eigen::ArrayXd s = twice_cos * sin_n - sin_before, c = twice_cos * cos_n - cos_before;
    sin_before.swap(sin_n);
    cos_before.swap(cos_n);
    sin_n.swap(s);
    cos_n.swap(c);
  }
};

struct Lag {
  double time_constant_s = 0.0;  // 0: none
  Eigen::ArrayXd step;           // 1 - exp(-dt / T) per sample; 1 starts a new part
};

Lag lag_of(const Predictor& predictor, const WhitenedResiduals& residuals, const Candidate& model) {
  Lag lag;
  lag.step = Eigen::ArrayXd::Ones(residuals.size());
  if (predictor.method() == Method::kInverse) return lag;
  const DriveParams<double> d = drive_of(model);
  const double k = d.torque_constant_Nm_per_A;
  const double damping =
      d.viscous_friction_Nm_s_per_rad + (d.resistance_ohm > 0.0 ? k * k / d.resistance_ohm : 0.0);
  if (damping <= 0.0 || inertia_at_rotor(d) <= 0.0) return lag;
  lag.time_constant_s = inertia_at_rotor(d) / damping;
  for (const WhitenedResiduals::Part& part : residuals.parts()) {
    const std::vector<double>& time_s =
        predictor.compared(part.run)[static_cast<std::size_t>(part.signal)].time_s;
    for (std::size_t i = 1; i < part.rows.size(); ++i) {
      const double dt_s =
          time_s[static_cast<std::size_t>(part.rows[i])] - time_s[static_cast<std::size_t>(part.rows[i - 1])];
      lag.step[part.first + static_cast<Eigen::Index>(i)] = -std::expm1(-dt_s / lag.time_constant_s);
    }
  }
  return lag;
}

void send_through(const Lag& lag, Eigen::ArrayXd& x) {
  if (lag.time_constant_s <= 0.0) return;
  double y = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    y = lag.step[i] == 1.0 ? 0.0 : y + lag.step[i] * (x[i] - y);
    x[i] = y;
  }
}

// Energy that a sine and a cosine take from the residual, fitted to each part by itself; `taken`: the fitted
// sum of both. All vectors: n samples of WhitenedResiduals. Below 1e-9 of energy or 1e-6 of the determinant
// an order was not excited (numerical rank).
double energy_of(const WhitenedResiduals& residuals, const Eigen::ArrayXd& s, const Eigen::ArrayXd& c,
                 const Eigen::VectorXd& r, Eigen::VectorXd* taken) {
  double energy = 0.0;
  for (const WhitenedResiduals::Part& part : residuals.parts()) {
    const Eigen::Index n = static_cast<Eigen::Index>(part.rows.size());
    Eigen::MatrixXd both(n, 2);
    both << s.segment(part.first, n).matrix(), c.segment(part.first, n).matrix();
    residuals.whiten_part(part, both);
    const auto sn = both.col(0), cn = both.col(1);
    const auto rn = r.segment(part.first, n);
    Eigen::Matrix2d gram;
    gram << sn.squaredNorm(), sn.dot(cn), sn.dot(cn), cn.squaredNorm();
    const double separate = gram(0, 0) * gram(1, 1), determinant = separate - gram(0, 1) * gram(1, 0);
    if (gram(0, 0) < 1e-9 || gram(1, 1) < 1e-9 || determinant < 1e-6 * separate) continue;
    const Eigen::Vector2d b(sn.dot(rn), cn.dot(rn));
    const Eigen::VectorXd a = ldlt_solve(gram, b);
    energy += b.dot(a);
    if (taken != nullptr) taken->segment(part.first, n) = a[0] * sn + a[1] * cn;
  }
  return energy;
}

struct Best {
  int order = 0;
  double energy = 0.0;
  double median = 0.0;
  Eigen::VectorXd taken;
};

Best best_order(const WhitenedResiduals& residuals, const Lag& lag, const Eigen::ArrayXd& theta,
                const Eigen::ArrayXd& fastest, const Eigen::VectorXd& residual) {
  Angles angles(theta);
  std::vector<double> energies;
  Best best;
  for (int order = 1; order <= kHighestOrder; ++order, angles.next()) {
    const Eigen::ArrayXd seen = (fastest * order < kFastest_rad).cast<double>();
    Eigen::ArrayXd s = angles.sin_n * seen, c = angles.cos_n * seen;
    send_through(lag, s);
    send_through(lag, c);
    const double energy = energy_of(residuals, s, c, residual, nullptr);
    energies.push_back(energy);
    if (energy <= best.energy) continue;
    best.order = order;
    best.energy = energy;
    best.taken = Eigen::VectorXd::Zero(residual.size());
    energy_of(residuals, s, c, residual, &best.taken);
  }
  best.median = median_in_place(energies);
  return best;
}

}  // namespace

std::vector<OrderPeak> strong_orders(const Predictor& predictor, const WhitenedResiduals& residuals,
                                     const Candidate& model, Eigen::VectorXd weighted_residual, int most) {
  std::vector<OrderPeak> peaks;
  const Eigen::VectorXd angle = residuals.track(model, "rotor_angle");
  const Eigen::VectorXd speed = residuals.track(model, "speed");
  if (!angle.allFinite() || residuals.empty()) return peaks;
  Eigen::ArrayXd per_sample_rad = Eigen::ArrayXd::Zero(residuals.size());
  for (const WhitenedResiduals::Part& part : residuals.parts()) {
    const std::vector<double>& time_s =
        predictor.compared(part.run)[static_cast<std::size_t>(part.signal)].time_s;
    for (std::size_t i = 1; i < part.rows.size(); ++i) {
      const Eigen::Index at = part.first + static_cast<Eigen::Index>(i);
      const double dt_s =
          time_s[static_cast<std::size_t>(part.rows[i])] - time_s[static_cast<std::size_t>(part.rows[i - 1])];
      const bool moves = std::isfinite(speed[at]) && !predictor.run(part.run).steady;
      per_sample_rad[at] = moves ? std::abs(speed[at]) * dt_s : 0.0;
    }
  }
  const Lag lag = lag_of(predictor, residuals, model);
  const double all = weighted_residual.squaredNorm();
  while (static_cast<int>(peaks.size()) < most) {
    const Best best = best_order(residuals, lag, angle.array(), per_sample_rad, weighted_residual);
    if (best.order == 0 || best.energy < kLeastShare * all || best.energy < kStandsOut * best.median) break;
    peaks.push_back({.order = static_cast<double>(best.order), .share = best.energy / all});
    weighted_residual -= best.taken;
  }
  return peaks;
}

}  // namespace omnihil
