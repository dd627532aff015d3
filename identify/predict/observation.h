// How a channel sees its rig's motion: which quantity of it, in which way, with which noise. One description for all
// rigs; a rig gives the motion (predictor_rig.h).
//
//   add_signal(run, {.quantity = Quantity::kCurrent, .view = View::kMean}, "motor_current", "A", time_s, measured, 0.05);
//   std::vector<Jet> y =
//       observed<Jet>(run.seen[0], time_s, [&](std::size_t k) { return motion[k].motor_current_A; });
//   complete(run, prediction);                             // levels and filters, of values and derivatives alike
//   add_sensor_noise(run, 0, seed, stream, values);        // readings of signal 0 where these are the true values
#pragma once
#include <string>
#include <vector>

#include "identify/predict/channel.h"
#include "identify/predict/own_clock.h"
#include "identify/record/filter.h"

namespace omnihil {

// What sensors see, of whatever moves.
enum class Quantity : std::uint8_t {
  kSpeed,  // as the drive reports it
  kPosition,
  kCounts,      // of an encoder, unrounded
  kWheelSpeed,  // as telemetry has it
  kCurrent,
  kTemperature,
  kBusVoltage,
  kLoadTorque,
  kNeededInput,  // drive input that an imposed motion takes
  kGyro,
  kAccelerometer,  // along x, along y
  kPose,           // x, y, heading
  kForce,          // x, y
};

enum class View : std::uint8_t {
  kPoint,       // at the sample
  kMean,        // over the period that ends there: of a run's first sample nothing is known
  kLevel,       // a mean, up to a level that is the run's own (a battery's): means are made equal
  kDifference,  // its change since the last known sample, over the time between: positions, counts
  kFrames,      // at a camera's frames, from where the first one saw it
};

struct Observation {
  Quantity quantity = Quantity::kSpeed;
  View view = View::kPoint;
  std::string channel = {};  // of the dataset
  std::size_t part = 0;      // of a quantity that has several: the wheel, or the axis
  double per_unit = 1.0;     // of a difference: the quantity's units in one of the compared signal's, times s
  double channel_sigma = 0.0;  // of the channel's own noise, in its unit: stated, or estimated
  std::vector<std::size_t> from =
      {};  // of a difference, per sample: the earlier one, or itself where there is none
};

// A run's compared signals, whatever the rig.
struct RigRun {
  std::vector<ComparedSignal> compared;
  std::vector<Observation> seen;  // one per compared signal
  LowPass filter;                 // of measurement and prediction alike, without delay; no sections: none
  std::vector<double> given;      // of a needed input: the one that was given, filtered alike
  OwnClock clock;                 // of a camera beside the rig
};

// A mean's first sample is taken out of `measured`. stated_sigma: 0: estimated. Without it the noise is the caller's to set.
ComparedSignal& add_signal(RigRun& run, Observation how, std::string name, std::string unit,
                           const std::vector<double>& time_s, std::vector<double> measured);
ComparedSignal& add_signal(RigRun& run, Observation how, std::string name, std::string unit,
                           const std::vector<double>& time_s, std::vector<double> measured,
                           double stated_sigma);

// Of a channel as it is: with its name, its unit and its stated noise.
ComparedSignal& add_channel(RigRun& run, Observation how, const Channel& channel,
                            const std::vector<double>& time_s, std::vector<double> measured);

// Differences of successive known values of `x` over the time between them, but for gaps longer than `gap_s`; its sigma
// and quantum in the compared signal's unit times s. whitening_s: ComparedSignal.
ComparedSignal& add_difference(RigRun& run, Observation how, std::string name, std::string unit,
                               const std::vector<double>& time_s, const std::vector<double>& x, double gap_s,
                               double sigma, double quantum, double whitening_s);

// Of n samples: quantity(k), or what its view makes of it. Levels are left to complete().
template <typename T, typename Get>
std::vector<T> observed(const Observation& how, const std::vector<double>& time_s, Get quantity) {
  std::vector<T> out;
  out.reserve(time_s.size());
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    if (how.view != View::kDifference) {
      out.push_back(quantity(k));
    } else if (const std::size_t from = how.from[k]; from < k) {
      out.push_back((quantity(k) - quantity(from)) / (how.per_unit * (time_s[k] - time_s[from])));
    } else {
      out.push_back(T(kMissing));
    }
  }
  return out;
}

// Of all of a run's signals: quantity(how, k).
template <typename T, typename Get>
std::vector<std::vector<T>> observed(const RigRun& run, const std::vector<double>& time_s, Get quantity) {
  std::vector<std::vector<T>> out;
  for (const Observation& how : run.seen)
    out.push_back(observed<T>(how, time_s, [&](std::size_t k) { return quantity(how, k); }));
  return out;
}

// What is linear in values and derivatives alike: levels, filters, shifts of a clock. A measured sample that is not predicted is a
// divergence.
void complete(const RigRun& run, Prediction& p);
void complete(const RigRun& run, std::size_t signal, bool is_value, Eigen::Ref<Eigen::VectorXd> column);
inline void complete(const RigRun& run, std::size_t signal, bool is_value, std::vector<double>& column) {
  complete(run, signal, is_value,
           Eigen::Map<Eigen::VectorXd>(column.data(), static_cast<Eigen::Index>(column.size())));
}

// Root mean square of (a - b) / noise, the largest of the run's signals, unweighted and whitened.
double distance(const RigRun& run, const Prediction& a, const Prediction& b);

// Of `values`, true: noise where it enters the sensor, and its rounding. What was not measured is NaN afterwards.
void add_sensor_noise(const RigRun& run, std::size_t signal, std::uint64_t seed, std::uint64_t stream,
                      std::vector<double>& values);

// The sensors of `to` are those of `from`: sigmas are not estimated anew.
void keep_sensors(const RigRun& from, RigRun& to);

// A signal has one noise in all runs: where it is neither stated nor whitened, the median of the runs'. Not of a run that is
// compared in a band: what the band keeps depends on how far the motion stands out, which each run decides for itself.
void share_noise(std::span<RigRun* const> runs);

// Gives differenced signals the shortest time, by doubling, over which their displacement is kResolved_sigmas times the
// noise of its two ends, rms over the training runs; the same in all runs.
void choose_averaging(const Dataset& dataset, std::span<RigRun* const> runs);

}  // namespace omnihil
