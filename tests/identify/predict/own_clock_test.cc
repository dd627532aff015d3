// A camera whose clock is off by one unknown time in a run: what is left of a residual, and what a model of a delay gains by it.
#include "identify/predict/own_clock.h"

#include <gtest/gtest.h>

#include <cmath>

#include "identify/predict/observation.h"
#include "tests/identify/simulated_radio.h"

namespace omnihil::test {
namespace {

// y = a t^2 / 2, sampled every T; rates by the samples beside each are a t, at both ends a (t ± T / 2).
constexpr double kAccel = 2.0, kPeriod_s = 0.02, kNoise = 0.01, kClock_s = 0.03;
constexpr std::size_t kSamples = 50;
double time_of(std::size_t k) { return kPeriod_s * static_cast<double>(k); }
double place(std::size_t k) { return 0.5 * kAccel * time_of(k) * time_of(k); }
// Less that at the first frame.
double rate(std::size_t k) {
  const double t = k == 0 ? 0.5 * kPeriod_s : k + 1 == kSamples ? time_of(k) - 0.5 * kPeriod_s : time_of(k);
  return kAccel * (t - 0.5 * kPeriod_s);
}

struct Path {
  explicit Path(double sigma_s) {
    std::vector<double> t;
    for (std::size_t k = 0; k < kSamples; ++k) t.push_back(time_of(k));
    add_signal(run, {.view = View::kFrames}, "vision_x", "m", t, std::vector<double>(kSamples, 0.0), kNoise);
    run.clock = {.sigma_s = sigma_s, .follow_s = 0.0, .signals = {0}};
    p.values.emplace_back();
    for (std::size_t k = 0; k < kSamples; ++k) {
      p.values[0].push_back(place(k));
      run.compared[0].measured[k] = place(k);
      square += std::pow(rate(k) / kNoise, 2);
    }
  }
  RigRun run;
  Prediction p;
  double square = 0.0;  // of the rates, in units of the noise
};

TEST(OwnClock, OfAShiftIsLeftWhatItsPriorCosts) {
  constexpr double kShift_s = 0.04;
  Path path(kClock_s);
  for (std::size_t k = 0; k < kSamples; ++k) path.run.compared[0].measured[k] += kShift_s * rate(k);
  complete(path.run, path.p);
  double left = 0.0;
  for (std::size_t k = 0; k < kSamples; ++k) {
    const double r = path.run.compared[0].measured[k] - path.p.values[0][k];
    EXPECT_NEAR(r, kShift_s * rate(k) / std::sqrt(1.0 + kClock_s * kClock_s * path.square), 1e-12);
    left += r * r / (kNoise * kNoise);
  }
  // min over d of q'q (D - d)^2 + d^2 / s^2 = D^2 / (s^2 + 1 / q'q)
  EXPECT_NEAR(left, kShift_s * kShift_s / (kClock_s * kClock_s + 1.0 / path.square), 1e-9);
}

TEST(OwnClock, WhatNoShiftMakesStays) {
  Path path(kClock_s);
  std::vector<double> other(kSamples);
  double along = 0.0;
  for (std::size_t k = 0; k < kSamples; ++k) {
    other[k] = 0.02 * std::cos(0.7 * static_cast<double>(k));
    along += other[k] * rate(k) / (kNoise * kNoise * path.square);
  }
  path.p.derivatives.emplace_back(kSamples, 2);
  for (std::size_t k = 0; k < kSamples; ++k) {
    other[k] -= along * rate(k);  // orthogonal to the rates
    path.run.compared[0].measured[k] += other[k];
    path.p.derivatives[0].row(static_cast<Eigen::Index>(k)) << other[k], rate(k);
  }
  complete(path.run, path.p);
  const double shrunk = 1.0 / std::sqrt(1.0 + kClock_s * kClock_s * path.square);
  for (std::size_t k = 0; k < kSamples; ++k) {
    EXPECT_NEAR(path.p.values[0][k], place(k), 1e-12);
    EXPECT_NEAR(path.p.derivatives[0](static_cast<Eigen::Index>(k), 0), other[k], 1e-12);
    EXPECT_NEAR(path.p.derivatives[0](static_cast<Eigen::Index>(k), 1), shrunk * rate(k), 1e-12);
  }
}

TEST(OwnClock, TheRecordsOwnIsNotShifted) {
  Path path(0.0);
  for (double& v : path.run.compared[0].measured) v += 0.3;
  const std::vector<double> before = path.p.values[0];
  complete(path.run, path.p);
  EXPECT_EQ(path.p.values[0], before);
}

// A frame at every so many rows.
Dataset with_clock(double sigma_s, std::size_t every = 1) {
  Dataset d = blank_radio(8.0);
  for (omnihil::Run& run : d.runs) {
    for (const char* name : {"vision_x", "vision_y", "vision_theta"}) {
      std::vector<double>& seen = run.signals[name];
      for (std::size_t k = 0; k < seen.size(); ++k) seen[k] = k % every == 0 ? 0.0 : kMissing;
    }
  }
  for (Channel& c : d.channels) {
    if (c.signal == "vision_x" || c.signal == "vision_y") c.clock_sigma_s = sigma_s;
  }
  return d;
}

double camera_energy(const Predictor& p, const Candidate& model, double* count = nullptr) {
  const Prediction y = p.predict(model, 0);
  double sum = 0.0;
  for (std::size_t s = 0; s < p.compared(0).size(); ++s) {
    const ComparedSignal& c = p.compared(0)[s];
    if (c.name != "vision_x" && c.name != "vision_y") continue;
    for (std::size_t k = 0; k < c.measured.size(); ++k) {
      const double r = (c.measured[k] - y.values[s][k]) / c.noise_sigma;
      if (!std::isfinite(r)) continue;
      sum += r * r;
      if (count != nullptr) *count += 1.0;
    }
  }
  return sum;
}

// The null's clocks are off by as much as is stated; the model that made them leaves white noise all the same.
TEST(OwnClock, ASimulatedCameraIsOffAndLeavesItsNoise) {
  const Candidate truth = radio_candidate();
  double square = 0.0;
  for (const std::uint64_t seed : {3u, 4u, 5u}) {
    const auto made = make_predictor(with_clock(0.03, 2), truth, {})->simulated(truth, seed);
    double count = 0.0;
    const double left = camera_energy(*made, truth, &count);
    EXPECT_NEAR(left / count, 1.0, 5.0 * std::sqrt(2.0 / count)) << seed;
    Dataset unstated = with_clock(0.0, 2);
    unstated.runs = {made->run(0), made->run(1)};
    square += camera_energy(*make_predictor(unstated, truth, {}), truth) / count;
  }
  EXPECT_GT(square / 3.0, 10.0);  // 0.03 s at half a metre a second are 15 times the noise
}

// y(t + d): the delay that a model may have gains no more than the prior of the shift, d^2 / s^2, says. A robot that does not
// turn: which way it looks is as late as where it is.
TEST(OwnClock, AShiftIsNoDelay) {
  constexpr double kDelay_s = 1.0 / 60.0;  // a row, so that no reading is between two
  constexpr double kGentle_m_s2 = 2.0;
  Candidate truth = radio_candidate();
  EXPECT_EQ(set_value(truth, "controller.acceleration_limit_m_s2", kGentle_m_s2), "");
  Candidate delayed = with_effect(truth, *find_effect("vision_delay"));
  EXPECT_EQ(set_value(delayed, "vision_delay.delay_s", kDelay_s), "");
  const auto straight = [](double sigma_s) {
    Dataset d = with_clock(sigma_s);
    for (omnihil::Run& run : d.runs) run.signals["command_w"].assign(run.time_s.size(), 0.0);
    return d;
  };
  const auto made = make_predictor(straight(0.0), truth, {})->simulated(truth, 6);
  for (const double sigma_s : {0.0, kClock_s}) {
    Dataset d = straight(sigma_s);
    for (std::size_t r = 0; r < d.runs.size(); ++r) {
      d.runs[r] = made->run(static_cast<int>(r));
      for (const char* name : {"vision_x", "vision_y", "vision_theta"}) {
        std::vector<double>& seen = d.runs[r].signals[name];
        seen.insert(seen.begin(), seen.front());
        seen.pop_back();
      }
    }
    const auto p = make_predictor(d, truth, {});
    double count = 0.0;
    const double gain = camera_energy(*p, truth, &count) - camera_energy(*p, delayed);
    if (sigma_s > 0.0) {
      const double second_order =
          0.5 * kGentle_m_s2 * kDelay_s * kDelay_s / 0.001;  // over the noise, at most
      EXPECT_LT(gain, std::pow(kDelay_s / sigma_s, 2) + second_order * second_order * count);
    } else {
      EXPECT_GT(gain, 1000.0);
    }
  }
}

// Poses half a period of the described loop late are no sign of anything: they cost what two instants within the period are
// worth, (0.5 ms over 1 ms / sqrt(6))^2 = 1.5, and what the shift leaves in second order. A robot that does not turn, gently.
TEST(OwnClock, WithinThePeriodOfADescribedLoopNoInstantIsKnown) {
  Candidate truth = radio_candidate();
  EXPECT_EQ(set_value(truth, "controller.acceleration_limit_m_s2", 1.0), "");
  Candidate late = with_effect(truth, *find_effect("vision_delay"));
  EXPECT_EQ(set_value(late, "vision_delay.delay_s", 0.5e-3), "");
  Dataset quiet = with_clock(0.0);
  for (Channel& c : quiet.channels)
    if (c.signal == "vision_x" || c.signal == "vision_y") c.sigma = 1e-4;
  for (omnihil::Run& run : quiet.runs) run.signals["command_w"].assign(run.time_s.size(), 0.0);
  const auto made = make_predictor(quiet, truth, {})->simulated(late, 6);
  EXPECT_LT(camera_energy(*made, truth) - camera_energy(*made, late), 1.5 + 5.0);
}

}  // namespace
}  // namespace omnihil::test
