#include "identify/estimate/packet_loss.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "identify/record/statistics.h"

namespace omnihil {
namespace {

constexpr double kPriorLoss = 0.02;       // of the league's radios 0 to 5 % is reported; a choice
constexpr double kAnswer_s = 0.08;        // after a command is heard its wheel has followed; a choice
constexpr std::size_t kFollowing = 3;     // commands that may be the lost one instead; a choice
constexpr double kMostCorrelated = 0.95;  // r at most; a choice

RobotMotionOptions own_path() {
  RobotMotionOptions options;
  options.follow_camera = false;
  options.rough = true;  // what steps of 1 ms are off by is the same with a command and without
  return options;
}

struct Speeds {
  std::size_t wheel;
  const std::vector<double>* measured;
  double sigma;
};

class Decisions {
 public:
  Decisions(const RobotModelValues<double>& model, const RobotRun& run)
      : model_(model), record_(run.record), ahead_s_(model.params.controller.latency_s + kAnswer_s) {
    for (std::size_t j = 0; j < run.seen.size(); ++j) {
      if (run.seen[j].quantity == Quantity::kWheelSpeed && run.seen[j].view == View::kPoint)
        speeds_.push_back({run.seen[j].part, &run.compared[j].measured, run.compared[j].noise_sigma});
    }
  }

  LostPackets made() {
    LostPackets out;
    if (speeds_.empty() || record_.size() < 2) return out;
    const RobotMotion<double> whole = run_robot(model_, record_, own_path());
    if (!whole.finite || !weigh(whole)) return out;
    std::size_t at = 0, heard = 0;  // rows: of the motion so far, of the last command that arrived
    while (heard < record_.size() && !record_.radio->said(heard)) ++heard;
    for (std::size_t k = heard + 1; k < record_.size(); ++k) {
      if (!record_.radio->said(k)) continue;
      if (record_.radio->value[k] == record_.radio->value[heard]) continue;
      go_on(at, k);
      at = k;
      ++out.tried;
      if (is_lost(k)) {
        out.rows.push_back(k);
        record_.radio->value[k].fill(kMissing);
      } else {
        heard = k;
      }
    }
    return out;
  }

 private:
  // sigma and tau, of the residuals of the whole run.
  bool weigh(const RobotMotion<double>& whole) {
    double product = 0.0, square = 0.0;
    for (Speeds& s : speeds_) {
      std::vector<double> residual, size;
      for (std::size_t k = 0; k < record_.size(); ++k) {
        const double r = (*s.measured)[k] - whole.samples[k].wheel_rad_s[s.wheel];
        if (std::isfinite(r)) residual.push_back(r), size.push_back(std::abs(r));
      }
      s.sigma = std::max(s.sigma, sigma_by_mad(std::move(size)));
      if (!(s.sigma > 0.0)) return false;
      for (double& r : residual)
        r = std::clamp(r / s.sigma, -3.0, 3.0);  // what was lost shall not count as correlated
      for (std::size_t n = 1; n < residual.size(); ++n)
        product += residual[n] * residual[n - 1], square += residual[n] * residual[n];
    }
    const double r = std::clamp(product / std::max(square, 1e-300), 0.0, kMostCorrelated);
    worth_one_ = (1.0 + r) / (1.0 - r);
    return true;
  }

  void go_on(std::size_t from, std::size_t to) {
    if (to > from) run_robot(model_, rows_of(record_, from, to), own_path(), &carry_);
  }

  double left(const RobotRecord& ahead, std::size_t from) const {
    RobotCarry<double> carry = carry_;
    const RobotMotion<double> motion = run_robot(model_, ahead, own_path(), &carry);
    double sum = 0.0;
    for (const Speeds& s : speeds_) {
      for (std::size_t n = 1; n < motion.samples.size(); ++n) {
        const double r = ((*s.measured)[from + n] - motion.samples[n].wheel_rad_s[s.wheel]) / s.sigma;
        if (std::isfinite((*s.measured)[from + n])) sum += r * r;
      }
    }
    return sum;
  }

  // Row to which the answer to what is said at row k reaches.
  std::size_t answered(std::size_t k) const {
    std::size_t to = k;
    while (to + 1 < record_.size() && record_.time_s[to] - record_.time_s[k] < ahead_s_) ++to;
    return to;
  }

  // Of the sets of at most two commands among this one and those that follow, the most probable to be lost has this one.
  bool is_lost(std::size_t k) const {
    std::vector<std::size_t> rows = {k};
    for (std::size_t j = k + 1; j < record_.size() && rows.size() <= kFollowing; ++j)
      if (record_.radio->said(j)) rows.push_back(j);
    const std::size_t to = answered(rows.back());
    if (to == k) return false;
    const RobotRecord ahead = rows_of(record_, k, to);
    const auto odds = [&](std::initializer_list<std::size_t> lost) {
      RobotRecord less = ahead;
      for (const std::size_t row : lost) less.radio->value[row - k].fill(kMissing);
      return -left(less, k) / (2.0 * worth_one_) +
             static_cast<double>(lost.size()) * std::log(kPriorLoss / (1.0 - kPriorLoss));
    };
    double with = odds({k}), without = odds({});
    if (with <= without) return false;
    for (std::size_t a = 1; a < rows.size(); ++a) {
      with = std::max(with, odds({k, rows[a]}));
      without = std::max(without, odds({rows[a]}));
      for (std::size_t b = a + 1; b < rows.size(); ++b) without = std::max(without, odds({rows[a], rows[b]}));
    }
    return with > without;
  }

  const RobotModelValues<double>& model_;
  RobotRecord record_;
  std::vector<Speeds> speeds_;
  double ahead_s_ = 0.0;
  double worth_one_ = 1.0;
  RobotCarry<double> carry_;
};

}  // namespace

LostPackets lost_packets(const RobotModelValues<double>& model, const RobotRun& run) {
  if (!run.record.radio) return {};
  return Decisions(model, run).made();
}

}  // namespace omnihil
