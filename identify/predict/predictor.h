// Predicted sensor readings: the model simulated on the measured inputs, through the same sensor chain as the
// measurement (counts, means over a period, filters, delays), signal by signal.
//
//   std::unique_ptr<Predictor> p = make_predictor(dataset, nominal, {});
//   Prediction y = p->predict(candidate, run);                           // y.values[s][i]
//   Prediction d = p->predict_with_derivatives(candidate, unknowns, run); // and d.derivatives[s](i, u)
//   residual = p->compared(run)[s].measured[i] - y.values[s][i];
//
// How an axis is run (Method), chosen per dataset by what it gives, the same for measurement, model and null:
//   kForward  free run from the first measured state: drives by duty, voltage or position target. Laws that
//             depend on the angle are given the measured angle, so that a small error of speed does not turn
//             into a wrong phase of cogging ("slaved angle"; not with a servo, whose loop holds the angle).
//   kInverse  the measured, low-pass filtered motion is imposed and the drive input that it takes is compared
//             with the one that was given, filtered alike: drives by torque or current, benches that impose
//             the speed, and runs of kind "steady".
// Where the bus voltage is measured it is the drive's input, and its drop about the run's mean is compared as
// well (the level drifts with the battery). Of a position servo the position is compared, not the speed that
// the servo makes of it. A run of an axis starts at its first row with a drive input; after a gap of more
// than ten periods it starts anew from the measured speed. An axis that is driven by duty or voltage at
// points of kind "steady" compares the input that each point needs. A rig "robot" is run forward in a body
// that follows the measured pose slowly enough not to hide an error. Pure functions of their arguments:
// predictions may run on several threads at once.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "identify/predict/candidate.h"
#include "identify/record/counted_speed.h"
#include "identify/record/dataset.h"

namespace omnihil {

enum class Method : std::uint8_t { kForward, kInverse };

// One measured signal of one run, with its noise: what a prediction is compared with. n samples.
struct ComparedSignal {
  std::string name;  // "velocity"; "motor_torque" where the method is inverse
  std::string unit;
  std::vector<double> time_s;
  std::vector<double> measured;  // NaN: not measured, or left out (said in `left_out`)
  double noise_sigma =
      0.0;  // 1-sigma per sample in `unit`, after the chain's own filters: stated, or estimated
  bool noise_is_stated = false;
  double noise_level_sigma =
      0.0;                 // of the noise's variance, over it: how well the level itself is known; 0: exactly
  double quantum = 0.0;    // of a counting sensor, in the signal's unit; 0: none
  CountedSpeed counted{};  // of a speed that is pulses over a window
  // The noise of differenced counts or positions is blue: successive errors cancel. See whitened().
  double whitening_s = 0.0;     // time constant of the whitening filter; 0: the noise is white already
  double whitened_sigma = 0.0;  // of whitened(), per sample; noise_sigma where whitening_s is 0
  // Differences of a coarse position: the time over which the sensor resolves the motion, see averaged(); 0:
  // its own period.
  double averaging_s = 0.0;
  std::string left_out;  // how many samples were left out and why; empty: none
  // `measured` with the samples of which the imposed motion does not say what they should be (undetermined.h): for figures that
  // others took over all rows. Empty: there are none.
  std::vector<double> with_undetermined;
};

// A regime variable at each compared sample, along which errors are sorted into bins: measured, else the
// model's; NaN where neither is known.
struct RegimeTrack {
  std::string name;  // "speed", "abs_current", "rotor_angle", "output_angle", "acceleration", "time",
      // "direction", "time_since_step", "temperature", "bus_voltage", "position", "command_age"
  std::string unit;
  std::vector<double> value;  // n samples, on the clock of the run's compared signals
};

struct Prediction {
  std::vector<std::vector<double>> values;  // [signal][sample], n samples each, in the signal's unit
  std::vector<Eigen::MatrixXd>
      derivatives;     // [signal] n x p, per the unknown's own unit; empty unless asked for
  bool finite = true;  // false: the run diverged; values after that are NaN
};

struct PredictOptions {
  double step_s = 100e-6;  // electrical sub-step, at most
  bool slave_angle = true;
};

class Predictor {
 public:
  virtual ~Predictor() = default;
  virtual Method method() const = 0;
  virtual int run_count() const = 0;
  virtual const Run& run(int run) const = 0;
  virtual const std::vector<ComparedSignal>& compared(int run) const = 0;
  // All signals of a run share one clock: compared(run)[s].time_s are equal.
  virtual std::vector<RegimeTrack> regimes(const Candidate& candidate, int run) const = 0;
  virtual Prediction predict(const Candidate& candidate, int run) const = 0;
  virtual Prediction predict_with_derivatives(const Candidate& candidate, std::span<const Unknown> unknowns,
                                              int run) const = 0;
  // A predictor of the same dataset whose measurement is simulated with `truth` (parametric bootstrap): noise
  // of the compared signals' size, through the same sensors, drawn from `seed`.
  virtual std::unique_ptr<Predictor> simulated(const Candidate& truth, std::uint64_t seed) const = 0;
  // What this rig, its drive input and its sensors have that effects may need (sim/law/demands.h).
  virtual Capabilities capabilities() const = 0;
  // Can this effect act here at all; "" or why not ("needs a camera").
  std::string applies(const EffectEntry& entry) const { return refusal(*entry.info, capabilities()); }
  // Does a simulation of a run take a large part of a second, and with derivatives several times that?
  virtual bool is_costly() const { return false; }
  // Do the readings carry this effect's quantisation signature (counted_speed.h)?
  virtual bool shows_signature_of(const EffectEntry&) const { return false; }
};

// Residuals (or derivatives of predictions) of one signal, filtered so that its sensor noise is white; fits
// and scores are computed on them. `columns`: n x any, filtered in place; `residual`: n. A speed v_i = (x_i -
// x_{i-1}) / dt_i from a position with white noise is integrated with a leak, y_i = exp(-dt_i / tau) y_{i-1}
// + r_i dt_i: the position's residual above 1 / (2 pi tau), so that low-frequency errors of speed keep their
// full weight and the counts' rounding cancels. The result has sigma `whitened_sigma`, in the position's
// unit. Other signals are returned as they are. A missing sample (NaN) stays missing and is passed over; it
// does not reset the integral.
void whiten(const ComparedSignal& signal, Eigen::Ref<Eigen::MatrixXd> columns);
std::vector<double> whitened(const ComparedSignal& signal, std::vector<double> residual);

// The same of differences of a coarse position, as errors are shown: a mean over the last `averaging_s`, so that
// v_i = (x_i - x_{i-m}) / averaging_s, whose rounding is m times smaller. What lies before the first sample and
// what is missing counts as no error. Other signals are returned as they are.
void average(const ComparedSignal& signal, Eigen::Ref<Eigen::MatrixXd> columns);
std::vector<double> averaged(const ComparedSignal& signal, std::vector<double> residual);
double averaged_sigma(const ComparedSignal& signal);  // noise of averaged(), per sample, in `unit`
// Time over which the displacement is this many times the noise of its two ends (rms): a choice, a tenth of what
// is shown is the sensor's.
inline constexpr double kResolved_sigmas = 10.0;  // a choice

std::unique_ptr<Predictor> make_predictor(const Dataset& dataset, const Candidate& nominal,
                                          const PredictOptions& options);

}  // namespace omnihil
