#include "identify/twin/twin_promise.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "identify/record/statistics.h"
#include "sim/law/symmetric.h"

namespace omnihil {
namespace {

constexpr double kLeastShare =
    1e-3;                       // of the mean square: no sample is that much better than the rest; a choice
constexpr double kHuber = 4.0;  // sigmas from which on a difference counts linearly; a choice
constexpr int kLags = 4;        // windows over which differences may hang together: two seconds; a choice

double mean(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v;
  return x.empty() ? 0.0 : sum / static_cast<double>(x.size());
}

// 1 + 2 sum of positive autocorrelations: the variance of a mean of dependent values over that of independent ones.
double serial_of(const std::vector<double>& u) {
  const double m = mean(u);
  const auto n = u.size();
  double square = 0.0;
  for (const double v : u) square += (v - m) * (v - m);
  double out = 1.0;
  for (std::size_t lag = 1; lag <= kLags && lag < n; ++lag) {
    double sum = 0.0;
    for (std::size_t k = lag; k < n; ++k) sum += (u[k] - m) * (u[k - lag] - m);
    if (square > 0.0) out += 2.0 * std::max(0.0, sum / square);
  }
  return out;
}

// Variances from n values are uncertain by sqrt(2 / n): two such errors more.
double few(std::size_t n) {
  return 1.0 + 2.0 * std::sqrt(2.0 / std::max<double>(1.0, static_cast<double>(n)));
}

// Told less expected, the robot's own offset taken off.
double difference(const TwinSignal& s, std::size_t k, const Eigen::VectorXd& offset) {
  return s.measured[k] - s.expected[k] - s.gains.row(static_cast<Eigen::Index>(k)).dot(offset);
}

// Numbers of a model are off by this share of a fault's least size, each for itself: where the robot skids, or a wheel comes to the
// edge of its grip, every gain is large, and so is what may be off there; a choice.
constexpr double kModelShare = 0.2;  // a choice

double variance_of(const SignalPromise& p, const TwinSignal& s, std::size_t k, const Eigen::VectorXd& least) {
  const double model2 =
      s.gains.row(static_cast<Eigen::Index>(k)).transpose().cwiseProduct(least).squaredNorm();
  return p.sigma * p.sigma + std::pow(p.late_s * s.slope[k], 2) + kModelShare * kModelShare * model2;
}

Eigen::VectorXd least_sizes(const TwinBank& bank) {
  Eigen::VectorXd least(static_cast<Eigen::Index>(bank.faults.size()));
  for (std::size_t f = 0; f < bank.faults.size(); ++f)
    least(static_cast<Eigen::Index>(f)) = bank.faults[f].least;
  return least;
}

Eigen::VectorXd learn_offset(const std::vector<TwinWindow>& healthy, const TwinBank& bank,
                             const TwinPromise& promise) {
  // Differences 0.1 s apart tell something new, six of 60 Hz do not: the prior weighs as much more. A choice.
  constexpr double kDependent = 6.0;  // a choice
  const auto n = static_cast<Eigen::Index>(bank.faults.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (Eigen::Index f = 0; f < n; ++f)
    normal(f, f) = kDependent / std::pow(bank.faults[static_cast<std::size_t>(f)].least, 2);
  for (const TwinWindow& w : healthy) {
    for (const TwinSignal& s : w.signals) {
      const SignalPromise& p = promise.signals.at(s.name);
      for (std::size_t k = 0; k < s.measured.size(); ++k) {
        const double v = variance_of(p, s, k, promise.least);
        const Eigen::VectorXd d = s.gains.row(static_cast<Eigen::Index>(k)).transpose();
        normal += d * d.transpose() / v;
        right += d * ((s.measured[k] - s.expected[k]) / v);
      }
    }
  }
  return ldlt_solve(normal, right);
}

void learn_signal(const std::vector<TwinWindow>& healthy, std::string_view name,
                  const Eigen::VectorXd& offset, SignalPromise& p) {
  std::vector<double> slope2, square;
  for (const TwinWindow& w : healthy) {
    for (const TwinSignal& s : w.signals) {
      for (std::size_t k = 0; s.name == name && k < s.measured.size(); ++k) {
        slope2.push_back(s.slope[k] * s.slope[k]);
        square.push_back(std::pow(difference(s, k, offset), 2));
      }
    }
  }
  const double all = mean(square);
  const auto [white, late] = two_terms(slope2, square);
  p.sigma = std::sqrt(std::max({white, kLeastShare * all, 1e-18}));
  p.late_s = std::sqrt(late);
  p.rms = std::sqrt(all);
}

void learn_excess(const std::vector<TwinScore>& scores, std::string_view name, SignalPromise& p) {
  std::vector<double> log_excess;
  double sum = 0.0, samples = 0.0;
  for (const TwinScore& w : scores) {
    for (const SignalScore& s : w.signals) {
      if (s.name != name || !(s.typical > 0.0)) continue;
      log_excess.push_back(std::log(s.typical));
      sum += s.excess * s.samples, samples += s.samples;
    }
  }
  if (log_excess.empty()) return;
  p.excess = sum / samples;
  p.log_mean = mean(log_excess);
  double square = 0.0;
  for (const double v : log_excess) square += (v - p.log_mean) * (v - p.log_mean);
  const double variance = square / static_cast<double>(log_excess.size());
  p.log_sigma = std::sqrt(std::max(0.05, variance * serial_of(log_excess) * few(log_excess.size())));
}

FaultPromise learn_fault(const std::vector<TwinScore>& scores, std::size_t f) {
  std::vector<double> size, information;
  FaultPromise p;
  for (const TwinScore& w : scores) {
    const FaultScore& s = w.faults[f];
    p.most_information = std::max(p.most_information, s.information);
    if (s.information > 0.0) size.push_back(s.size), information.push_back(s.information);
  }
  if (size.empty()) return p;
  constexpr int kRounds = 5;  // weights and bias by turns; by cost: the second round changes the third digit
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0.0, weight = 0.0;
    std::vector<double> square;
    for (std::size_t k = 0; k < size.size(); ++k) {
      const double w = 1.0 / p.variance(information[k]);
      sum += w * size[k];
      weight += w;
    }
    p.bias = sum / weight;
    for (std::size_t k = 0; k < size.size(); ++k)
      square.push_back(std::pow(size[k] - p.bias, 2) * information[k]);
    const auto [lambda2, tau2] = two_terms(information, square);
    p.lambda2 = std::max(lambda2, kLeastShare * mean(square) + 1e-12);
    p.tau2 = tau2;
  }
  std::vector<double> u;
  for (std::size_t k = 0; k < size.size(); ++k)
    u.push_back((size[k] - p.bias) / std::sqrt(p.variance(information[k])));
  p.serial = serial_of(u) * few(u.size());
  return p;
}

}  // namespace

double FaultPromise::variance(double information) const {
  const double believed = most_information > 0.0 ? std::min(information, most_information) : information;
  return serial * (lambda2 / std::max(believed, 1e-30) + tau2);
}

std::array<double, 2> two_terms(const std::vector<double>& x, const std::vector<double>& z) {
  double a = mean(z), b = 0.0;
  constexpr int kRounds = 8;  // of reweighting; a choice
  for (int round = 0; round < kRounds && a > 0.0; ++round) {
    double w0 = 0.0, w1 = 0.0, w2 = 0.0, z0 = 0.0, z1 = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double size = a + b * x[k], w = 1.0 / (size * size);
      w0 += w, w1 += w * x[k], w2 += w * x[k] * x[k], z0 += w * z[k], z1 += w * x[k] * z[k];
    }
    const double det = w0 * w2 - w1 * w1;
    const double a_new = det > 0.0 ? (w2 * z0 - w1 * z1) / det : -1.0;
    const double b_new = det > 0.0 ? (w0 * z1 - w1 * z0) / det : -1.0;
    if (a_new > 0.0 && b_new >= 0.0) {
      a = a_new, b = b_new;
    } else if (b_new < 0.0 || !(w2 > 0.0)) {
      a = z0 / w0, b = 0.0;
    } else {  // all of it grows with x: a stays small but there
      a = kLeastShare * mean(z), b = z1 / w2;
    }
  }
  return {a, b};
}

TwinPromise learned_promise(const std::vector<TwinWindow>& healthy, const TwinBank& bank) {
  TwinPromise p;
  for (const TwinWindow& w : healthy) {
    for (const TwinSignal& s : w.signals) p.signals.try_emplace(s.name);
  }
  p.least = least_sizes(bank);
  p.offset = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(bank.faults.size()));
  constexpr int kRounds = 3;  // noise and offset by turns; by cost: the third round changes the third digit
  for (int round = 0; round < kRounds; ++round) {
    for (auto& [name, signal] : p.signals) learn_signal(healthy, name, p.offset, signal);
    if (round + 1 < kRounds) p.offset = learn_offset(healthy, bank, p);
  }
  std::vector<TwinScore> scores;
  for (const TwinWindow& w : healthy) scores.push_back(twin_score(w, p, bank.faults.size()));
  for (auto& [name, signal] : p.signals) learn_excess(scores, name, signal);
  for (std::size_t f = 0; f < bank.faults.size(); ++f) p.faults.push_back(learn_fault(scores, f));
  return p;
}

namespace {

// v of a sample of which `left` is not explained.
double huber(double plain, double left) {
  return plain * std::max(1.0, std::abs(left) / (kHuber * std::sqrt(plain)));
}

// Gained and information of one fault in one signal: weights by what the signal's own best size leaves.
void score_fault(const Eigen::VectorXd& d, const std::vector<double>& r, const std::vector<double>& plain,
                 FaultScore& out) {
  double size = 0.0;
  for (const bool last : {false, true}) {
    double gained = 0.0, information = 0.0;
    for (std::size_t k = 0; k < r.size(); ++k) {
      const double g = d(static_cast<Eigen::Index>(k)), v = huber(plain[k], r[k] - g * size);
      gained += g * r[k] / v;
      information += g * g / v;
    }
    if (last) out.gained += gained, out.information += information;
    size = information > 0.0 ? gained / information : 0.0;
  }
}

}  // namespace

TwinScore twin_score(const TwinWindow& window, const TwinPromise& promise, std::size_t faults) {
  TwinScore out{.from_s = window.from_s, .to_s = window.to_s, .faults = {}, .signals = {}};
  out.faults.resize(faults);
  for (const TwinSignal& s : window.signals) {
    const auto known = promise.signals.find(s.name);
    if (known == promise.signals.end() || s.measured.empty()) continue;
    const SignalPromise& p = known->second;
    SignalScore score{
        .name = s.name, .wheel_speed = s.wheel_speed, .samples = static_cast<int>(s.measured.size())};
    std::vector<double> each, r, plain;
    for (std::size_t k = 0; k < s.measured.size(); ++k) {
      r.push_back(difference(s, k, promise.offset));
      plain.push_back(variance_of(p, s, k, promise.least));
      each.push_back(r[k] * r[k] / plain[k]);
      score.excess += r[k] * r[k] / huber(plain[k], r[k]) / score.samples;
      score.standing += s.measured[k] * s.measured[k] / (p.sigma * p.sigma) / score.samples;
    }
    score.typical = median(std::move(each));
    for (std::size_t f = 0; f < faults; ++f)
      score_fault(s.gains.col(static_cast<Eigen::Index>(f)), r, plain, out.faults[f]);
    out.signals.push_back(std::move(score));
  }
  for (FaultScore& f : out.faults) f.size = f.information > 0.0 ? f.gained / f.information : 0.0;
  return out;
}

std::vector<std::string> outside_card(const TwinPromise& promise,
                                      const std::map<std::string, double>& card_rmse, double times) {
  std::vector<std::string> out;
  for (const auto& [name, signal] : promise.signals) {
    const auto said = card_rmse.find(name);
    if (said == card_rmse.end() || !(said->second > 0.0) || signal.rms <= times * said->second) continue;
    out.push_back(fmt::format("{}: {:.3g} off while learning, its card says {:.3g} of unseen runs", name,
                              signal.rms, said->second));
  }
  return out;
}

}  // namespace omnihil
