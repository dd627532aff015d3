// What the difference between a healthy robot and its model is like: learned from a stretch of driving, held against a card.
//
//   TwinPromise promise = learned_promise(windows, bank);
//   TwinScore s = twin_score(window, promise, bank.faults.size());
//   s.faults[f].size, s.faults[f].information;           // size of fault f by this window alone; of variance 1 / information
//
// Noise of a told sample: v = sigma^2 + (late expected')^2 + sum_f (0.2 least_f d_f)^2, d the gains. What comes a little late is off
// by as much as it changes meanwhile: a busy computer and a filter that no model has look like this. By window and fault, with r =
// told - expected:
//   g = sum d r / v,  I = sum d^2 / v,  size = g / I
// More than four sigmas that a fault leaves of a difference count linearly (P. J. Huber, Ann. Math. Stat. 35, 1964: v grows with
// them), so that a lost packet or a skid does not speak for a whole window.
// What of all faults together, a little of each, explains the healthy stretch best (ridge regression, a fault's least size for its
// spread) is the robot's own and taken off every r: `offset`. What is left of sizes is not 0 +- 1 / sqrt(I): the model is off a
// little, in the same way for a while. So they are taken as
//   E size = bias,  var size = serial (lambda^2 / I + tau^2)
// with all four from the healthy windows: lambda^2 and tau^2 by least squares of (size - bias)^2 I over I, serial = 1 + 2 sum of
// the first autocorrelations that are positive (the variance of a mean of dependent values), and one more share for how few windows
// there were. Information beyond what the healthy stretch had is not believed.
// Cannot: know of a fault that was there from the beginning (outside_card tells, where there is a card); promise anything of
// driving much harder than what it learned from.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "identify/twin/twin_model.h"

namespace omnihil {

struct SignalPromise {
  double sigma = 0.0, late_s = 0.0, rms = 0.0;  // in the signal's unit; rms: of all differences
  double excess = 1.0;                          // mean r^2 / v over the healthy stretch
  double log_mean = 0.0, log_sigma = 1.0;       // of the log of a window's median r^2 / v
};

struct FaultPromise {
  double bias = 0.0, lambda2 = 1.0, tau2 = 0.0, serial = 1.0, most_information = 0.0;
  double variance(double information) const;
};

struct TwinPromise {
  std::map<std::string, SignalPromise, std::less<>> signals;
  std::vector<FaultPromise> faults;
  Eigen::VectorXd offset, least;  // by fault, in its unit
};

struct FaultScore {
  double size = 0.0, gained = 0.0, information = 0.0;  // gained: g
};
struct SignalScore {
  std::string name;
  bool wheel_speed = false;
  int samples = 0;
  double excess = 0.0;    // mean r^2 / v
  double typical = 0.0;   // median r^2 / v: a lost packet shows in a few samples, and is not in it
  double standing = 0.0;  // mean told^2 / sigma^2: what a line that tells nothing but 0 has
};
struct TwinScore {
  double from_s = 0.0, to_s = 0.0;
  std::vector<FaultScore> faults;
  std::vector<SignalScore> signals;
};

TwinPromise learned_promise(const std::vector<TwinWindow>& healthy, const TwinBank& bank);
TwinScore twin_score(const TwinWindow& window, const TwinPromise& promise, std::size_t faults);

// Signals of which the learned differences are more than `times` what the card says of unseen runs, a sentence each.
std::vector<std::string> outside_card(const TwinPromise& promise,
                                      const std::map<std::string, double>& card_rmse, double times);

// a, b >= 0 of z = a + b x by least squares weighted by 1 / z's own size squared (its standard error, if z is a square).
std::array<double, 2> two_terms(const std::vector<double>& x, const std::vector<double>& z);

}  // namespace omnihil
