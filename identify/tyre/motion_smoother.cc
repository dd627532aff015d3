#include "identify/tyre/motion_smoother.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>

namespace omnihil {
namespace {

using State = Eigen::Vector4d;
using Matrix = Eigen::Matrix4d;

constexpr double kBiasSigma = 0.3;  // of an accelerometer, m/s2: several times a calibrated one's; a choice
constexpr double kWide = 1e6;       // variance of what is not known at the start: any that is large; a choice
constexpr int
    kLeastPower = -2,
    kMostPower =
        12;  // of ten: of q. Robots' jerks are 1e2 to 1e4 m/s3 over milliseconds: a choice that holds them

Matrix transition(double h) {
  Matrix f = Matrix::Identity();
  f(0, 1) = f(1, 2) = h;
  f(0, 2) = 0.5 * h * h;
  return f;
}

Matrix process_noise(double q, double h) {
  Matrix n = Matrix::Zero();
  const double h2 = h * h, h3 = h2 * h;
  n(0, 0) = h3 * h2 / 20.0;
  n(0, 1) = n(1, 0) = h2 * h2 / 8.0;
  n(0, 2) = n(2, 0) = h3 / 6.0;
  n(1, 1) = h3 / 3.0;
  n(1, 2) = n(2, 1) = h2 / 2.0;
  n(2, 2) = h;
  return q * n;
}

struct Filter {
  State x = State::Zero();
  Matrix p = Matrix::Identity();
  double log_likelihood = 0.0;

  void see(const State& row, double value, double sigma) {
    const double s = row.dot(p * row) + sigma * sigma;
    const double innovation = value - row.dot(x);
    const State gain = p * row / s;
    x += gain * innovation;
    // Joseph's form: stays symmetric and positive.
    const Matrix left = Matrix::Identity() - gain * row.transpose();
    p = left * p * left.transpose() + sigma * sigma * gain * gain.transpose();
    log_likelihood -= 0.5 * (std::log(s) + innovation * innovation / s);
  }
  void see(const MotionSample& m) {
    if (std::isfinite(m.place)) see(State(1, 0, 0, 0), m.place, m.place_sigma);
    if (std::isfinite(m.acceleration)) see(State(0, 0, 1, 1), m.acceleration, m.acceleration_sigma);
  }
};

Filter begin(std::span<const MotionSample> samples) {
  Filter f;
  for (const MotionSample& m : samples) {
    if (!std::isfinite(m.place)) continue;
    f.x(0) = m.place;
    break;
  }
  f.p.diagonal() << kWide, kWide, kWide, kBiasSigma * kBiasSigma;
  return f;
}

double likelihood(std::span<const MotionSample> samples, double q) {
  Filter f = begin(samples);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k > 0) {
      const double h = samples[k].time_s - samples[k - 1].time_s;
      const Matrix t = transition(h);
      f.x = t * f.x;
      f.p = t * f.p * t.transpose() + process_noise(q, h);
    }
    f.see(samples[k]);
  }
  return f.log_likelihood;
}

}  // namespace

SmoothedMotion smooth_motion(std::span<const MotionSample> samples) {
  SmoothedMotion out;
  const std::size_t n = samples.size();
  out.at.resize(n);
  if (n == 0) return out;
  // A few thousand samples tell q as well as all.
  const std::span<const MotionSample> some = samples.first(std::min<std::size_t>(n, 6000));
  double best = -std::numeric_limits<double>::infinity();
  for (int power = kLeastPower; power <= kMostPower; ++power) {
    const double q = std::pow(10.0, power), l = likelihood(some, q);
    if (l <= best) continue;
    best = l;
    out.jerk_density = q;
  }
  std::vector<State> filtered(n), predicted(n);
  std::vector<Matrix> filtered_p(n), predicted_p(n), moved(n);
  Filter f = begin(samples);
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) {
      const double h = samples[k].time_s - samples[k - 1].time_s;
      moved[k] = transition(h);
      f.x = moved[k] * f.x;
      f.p = moved[k] * f.p * moved[k].transpose() + process_noise(out.jerk_density, h);
    }
    predicted[k] = f.x;
    predicted_p[k] = f.p;
    f.see(samples[k]);
    filtered[k] = f.x;
    filtered_p[k] = f.p;
  }
  out.log_likelihood = f.log_likelihood;
  State x = filtered[n - 1];
  Matrix p = filtered_p[n - 1];
  for (std::size_t k = n; k-- > 0;) {
    if (k + 1 < n) {
      const Matrix gain = filtered_p[k] * moved[k + 1].transpose() * predicted_p[k + 1].inverse();
      x = filtered[k] + gain * (x - predicted[k + 1]);
      p = filtered_p[k] + gain * (p - predicted_p[k + 1]) * gain.transpose();
    }
    out.at[k] = {x(0), x(1), x(2), std::sqrt(std::max(0.0, p(1, 1))), std::sqrt(std::max(0.0, p(2, 2)))};
  }
  return out;
}

}  // namespace omnihil
