// Rigs on wheels that roll on a floor, as a predictor has them (predictor_rig.h): records, signals, noise and null of any
// of them. A kind says which.
#pragma once
#include <algorithm>
#include <concepts>
#include <memory>
#include <utility>
#include <vector>

#include "identify/predict/channel.h"
#include "identify/predict/predictor_rig.h"
#include "identify/predict/robot_motion.h"
#include "identify/predict/robot_signals.h"
#include "sim/law/random.h"
#include "sim/model/rolling_model.h"

namespace omnihil {

// What it makes of a robot's parameters, and what effects may need of it.
template <class K>
concept RollingKind = requires(const RollingParams<double>& robot, const RollingParams<Jet>& jets,
                               const Dataset& dataset) {
  { K::params(robot) } -> std::same_as<RollingParams<double>>;
  { K::params(jets) } -> std::same_as<RollingParams<Jet>>;
  { K::capabilities(dataset) } -> std::same_as<Capabilities>;
};

template <RollingKind Kind>
class RollingRig {
 public:
  RollingRig(std::shared_ptr<const Dataset> dataset, std::shared_ptr<const Candidate> nominal,
             const PredictOptions& options)
      : dataset_(std::move(dataset)), nominal_(std::move(nominal)), options_(options) {
    motion_.slave_angle = options.slave_angle;
    motion_.firmware = dataset_->firmware.get();
    if (dataset_->firmware)
      tick_s_ = 1e-9 * static_cast<double>(dataset_->firmware->fresh()->control_period_ns());
    for (const Run& run : dataset_->runs) {
      const Candidate model = with_known(*nominal_, run.known);
      records_.push_back(robot_record(*dataset_, run, Kind::params(rolling_params(model.file.parameters))));
      signals_.push_back(robot_signals(*dataset_, run, records_.back()));
    }
    share_channels();
    for (std::size_t n = 0; n < records_.size(); ++n) {
      add_input_noise(with_known(*nominal_, dataset_->runs[n].known), records_[n], signals_[n]);
      compared_.emplace_back();
      for (const RobotSignal& s : signals_[n]) compared_.back().push_back(s.compared);
    }
  }

  const Dataset& dataset() const { return *dataset_; }
  Method method() const { return Method::kForward; }
  const std::vector<ComparedSignal>& compared(std::size_t n) const { return compared_[n]; }
  bool shows_signature_of(const EffectEntry&) const { return false; }
  double step_s(const Candidate&, std::size_t) const { return motion_.step_s; }
  // Of a loop that is closed by a firmware nothing is known but its answers.
  bool is_exact(const Candidate&, std::size_t n) const {
    return motion_.firmware == nullptr || !records_[n].radio;
  }
  void complete(std::size_t, Prediction&) const {}
  std::vector<RegimeTrack> regimes(const Candidate& own, std::size_t n) const {
    return robot_regimes(dataset_->runs[n], records_[n],
                         run_robot(values_of<double>({own}), records_[n], motion_));
  }

  template <typename T>
  RigOutputs<T> outputs(const RigModel& model, std::size_t n, double) const {
    const RobotMotion<T> motion = run_robot(values_of<T>(model), records_[n], motion_);
    RigOutputs<T> out{.values = {}, .finite = motion.finite};
    for (const RobotSignal& s : signals_[n])
      out.values.push_back(robot_signal_values(s, records_[n], motion));
    return out;
  }

  // A firmware counts its encoders in whole counts and rounds its duties, so that a prediction is a staircase of a
  // parameter: the difference is taken over a stretch that matters, and not over the least that a double has.
  Secant secant(const Candidate& own, const Unknown& unknown, Eigen::Index, std::size_t n,
                const Prediction&) const {
    constexpr double kShare = 0.5;  // of the unknown's scale: a choice
    if (is_exact(own, n)) return {};
    // A packet is heard at a tick, whichever moment between two it came at.
    const double least_s = unknown.path == "controller.latency_s" ? 2.0 * tick_s_ : 0.0;
    return {.width = std::max(kShare * unknown.scale, least_s)};
  }

  void measure(const Candidate& truth, std::uint64_t seed);
  Capabilities capabilities() const { return Kind::capabilities(*dataset_); }

 private:
  template <typename T>
  static RobotModelValues<T> values_of(const RigModel& model) {
    auto values = robot_values<T>(model.candidate, model.unknowns, model.first);
    values.params = Kind::params(values.params);
    return values;
  }
  void share_channels() {
    std::vector<ComparedSignal*> all;
    for (std::vector<RobotSignal>& of : signals_) {
      for (RobotSignal& s : of) all.push_back(&s.compared);
    }
    share_noise(all);
    for (std::vector<RobotSignal>& of : signals_) {
      for (RobotSignal& s : of) {
        if (!s.compared.noise_is_stated) s.channel_sigma = s.compared.noise_sigma;
      }
    }
  }
  void add_input_noise(const Candidate& model, const RobotRecord& record, std::vector<RobotSignal>& signals) {
    if (record.size() < 2 || (record.duty_quantum == 0.0 && record.bus_sigma_V == 0.0)) return;
    const auto values = values_of<double>({model});
    const RobotMotion<double> motion = run_robot(values, record, motion_);
    const RobotMotion<double> other = run_robot(values, with_input_noise(record, kNoiseSeed), motion_);
    if (motion.finite && other.finite) omnihil::add_input_noise(record, motion, other, signals);
  }
  // Any: the draw is used for the rms of the noise floor alone.
  static constexpr std::uint64_t kNoiseSeed = 1;  // as above

  std::shared_ptr<const Dataset> dataset_;
  std::shared_ptr<const Candidate> nominal_;
  PredictOptions options_;
  RobotMotionOptions motion_;
  double tick_s_ = 0.0;  // of the firmware
  std::vector<RobotRecord> records_;
  std::vector<std::vector<RobotSignal>> signals_;
  std::vector<std::vector<ComparedSignal>> compared_;
};

template <RollingKind Kind>
void RollingRig<Kind>::measure(const Candidate& truth, std::uint64_t seed) {
  auto made = std::make_shared<Dataset>(*dataset_);
  std::vector<RobotMotion<double>> motions;
  const auto own_seed = [&](std::size_t n) { return mix_bits(seed ^ mix_bits(n)); };
  for (std::size_t n = 0; n < made->runs.size(); ++n) {
    RobotMotionOptions free = motion_;
    free.slave_angle = false;
    free.follow_camera = false;
    free.noise_seed = own_seed(n);
    const Candidate own = with_known(truth, made->runs[n].known);
    // the true inputs: duties before rounding, bus voltage without its sensor's noise
    RobotRecord true_input = with_input_noise(records_[n], own_seed(n));
    true_input.bus_voltage_V = records_[n].bus_voltage_V;
    motions.push_back(run_robot(values_of<double>({own}), true_input, free));
    measure_robot(records_[n], motions.back(), signals_[n], own_seed(n), made->runs[n]);
  }
  RollingRig null(made, nominal_, options_);
  for (std::size_t n = 0; n < made->runs.size(); ++n) {
    for (std::size_t s = 0; s < null.signals_[n].size(); ++s) {
      RobotSignal& signal = null.signals_[n][s];
      if (signal.output == RobotOutput::kBusVoltage) {
        measure_robot_bus(records_[n], motions[n], own_seed(n), signal);
        null.compared_[n][s] = signal.compared;
      }
      // the sensors are those of the recording: sigmas are not estimated anew
      signal.channel_sigma = signals_[n][s].channel_sigma;
      null.compared_[n][s].noise_sigma = compared_[n][s].noise_sigma;
      null.compared_[n][s].whitened_sigma = compared_[n][s].whitened_sigma;
    }
  }
  *this = std::move(null);
}

inline bool has_channel(const Dataset& dataset, std::string_view prefix) {
  return std::any_of(dataset.channels.begin(), dataset.channels.end(),
                     [&](const Channel& c) { return c.signal.starts_with(prefix); });
}

}  // namespace omnihil
