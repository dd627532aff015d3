#include "identify/predict/predictor_robot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/predict/predictor_rig.h"
#include "identify/predict/robot_motion.h"
#include "identify/predict/robot_signals.h"
#include "sim/law/random.h"
#include "sim/model/rolling_model.h"

namespace omnihil {
namespace {

class RobotRig {
 public:
  RobotRig(std::shared_ptr<const Dataset> dataset, std::shared_ptr<const Candidate> nominal,
           const PredictOptions& options)
      : dataset_(std::move(dataset)), nominal_(std::move(nominal)), options_(options) {
    motion_.slave_angle = options.slave_angle;
    motion_.firmware = dataset_->firmware.get();
    if (dataset_->firmware)
      tick_s_ = 1e-9 * static_cast<double>(dataset_->firmware->fresh()->control_period_ns());
    for (const Run& run : dataset_->runs) {
      const Candidate model = with_known(*nominal_, run.known);
      records_.push_back(robot_record(*dataset_, run, rolling_params(model.file.parameters)));
      signals_.push_back(robot_signals(*dataset_, run, records_.back()));
      add_input_noise(model, records_.back(), signals_.back());
      compared_.emplace_back();
      for (const RobotSignal& s : signals_.back()) compared_.back().push_back(s.compared);
    }
  }

  const Dataset& dataset() const { return *dataset_; }
  Method method() const { return Method::kForward; }
  const std::vector<ComparedSignal>& compared(std::size_t n) const { return compared_[n]; }
  bool shows_signature_of(const EffectEntry&) const { return false; }
  double step_s(const Candidate&, std::size_t) const { return motion_.step_s; }
  // Of a loop that is closed by a firmware nothing is known but its answers.
  bool is_exact(std::size_t n) const { return motion_.firmware == nullptr || !records_[n].radio; }
  void complete(std::size_t, Prediction&) const {}
  std::vector<RegimeTrack> regimes(const Candidate& own, std::size_t n) const {
    return robot_regimes(dataset_->runs[n], records_[n],
                         run_robot(robot_values<double>(own, {}, 0), records_[n], motion_));
  }

  template <typename T>
  RigOutputs<T> outputs(const RigModel& model, std::size_t n, double) const {
    const auto values = robot_values<T>(model.candidate, model.unknowns, model.first);
    const RobotMotion<T> motion = run_robot(values, records_[n], motion_);
    RigOutputs<T> out{.values = {}, .finite = motion.finite};
    for (const RobotSignal& s : signals_[n])
      out.values.push_back(robot_signal_values(s, records_[n], motion));
    return out;
  }

  // A firmware counts its encoders in whole counts and rounds its duties, so that a prediction is a staircase of a
  // parameter: the difference is taken over a stretch that matters, and not over the least that a double has.
  double secant(const Candidate&, const Unknown& unknown, Eigen::Index, std::size_t n,
                const Prediction&) const {
    constexpr double kShare = 0.25;  // of the unknown's scale to either side: a choice
    if (is_exact(n)) return 0.0;
    // A packet is heard at a tick, whichever moment between two it came at.
    const double least_s = unknown.path == "controller.latency_s" ? tick_s_ : 0.0;
    return std::max(kShare * unknown.scale, least_s);
  }

  void measure(const Candidate& truth, std::uint64_t seed);
  Capabilities capabilities() const;

 private:
  void add_input_noise(const Candidate& model, const RobotRecord& record, std::vector<RobotSignal>& signals) {
    if (record.size() < 2 || (record.duty_quantum == 0.0 && record.bus_sigma_V == 0.0)) return;
    const auto values = robot_values<double>(model, {}, 0);
    const RobotMotion<double> motion = run_robot(values, record, motion_);
    const RobotMotion<double> other = run_robot(values, with_input_noise(record, kNoiseSeed), motion_);
    if (motion.finite && other.finite) omnihil::add_input_noise(record, motion, other, signals);
  }
  // Any: the draw is used for the rms of the noise floor alone.
  static constexpr std::uint64_t kNoiseSeed = 1;  // as above

  bool has_channel(std::string_view prefix) const {
    return std::any_of(dataset_->channels.begin(), dataset_->channels.end(),
                       [&](const Channel& c) { return c.signal.starts_with(prefix); });
  }

  std::shared_ptr<const Dataset> dataset_;
  std::shared_ptr<const Candidate> nominal_;
  PredictOptions options_;
  RobotMotionOptions motion_;
  double tick_s_ = 0.0;  // of the firmware
  std::vector<RobotRecord> records_;
  std::vector<std::vector<RobotSignal>> signals_;
  std::vector<std::vector<ComparedSignal>> compared_;
};

void RobotRig::measure(const Candidate& truth, std::uint64_t seed) {
  auto made = std::make_shared<Dataset>(*dataset_);
  std::vector<RobotMotion<double>> motions;
  const auto own_seed = [&](std::size_t n) { return mix_bits(seed ^ mix_bits(n)); };
  for (std::size_t n = 0; n < made->runs.size(); ++n) {
    RobotMotionOptions free = motion_;
    free.slave_angle = false;
    free.follow_camera = false;
    free.noise_seed = own_seed(n);
    const auto model = robot_values<double>(with_known(truth, made->runs[n].known), {}, 0);
    // the true inputs: duties before rounding, bus voltage without its sensor's noise
    RobotRecord true_input = with_input_noise(records_[n], own_seed(n));
    true_input.bus_voltage_V = records_[n].bus_voltage_V;
    motions.push_back(run_robot(model, true_input, free));
    measure_robot(records_[n], motions.back(), signals_[n], own_seed(n), made->runs[n]);
  }
  RobotRig null(made, nominal_, options_);
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

Capabilities RobotRig::capabilities() const {
  const bool camera = has_channel("vision");
  const bool body = camera || has_channel("gyro") || has_channel("accel");
  // Several drives by duty from one bus, simulated as a whole. Base parameters exclude no effect: what a tolerance
  // of an inductance trades with is for the fit to say.
  constexpr std::uint32_t kAlways = kNeedsFloor | kNeedsSeveralMotors | kNeedsSupply | kNeedsWinding |
                                    kNeedsDuty | kNeedsVoltage | kNeedsSimulation;
  // Where radio commands drive, the model's controller has the delay.
  std::vector<std::string> present;
  if (std::any_of(records_.begin(), records_.end(), [](const RobotRecord& r) { return r.radio.has_value(); }))
    present.emplace_back("controller.latency_s");
  return {
      .rig = kOnRobot,
      .other_rig = "acts on a single axis",
      .list = {{kAlways, true, ""},
               {kNeedsTwoInertias, false,
                "needs a freedom between rotor and wheel, which a robot's model lacks"},
               {kNeedsPositionServo, false, "needs a position servo"},
               {kNeedsReportedSpeed, false, "needs a speed that the drive's electronics estimate"},
               {kNeedsCamera, camera, "needs a camera"},
               {kNeedsDribbler, has_channel("dribbler"), "needs the dribbler's speed (channel dribbler)"},
               {kNeedsBodySpeed, body, "needs a body's speed: camera, gyro or accelerometer"},
               {kNeedsShaftSensor | kNeedsEncoder | kNeedsAngle, has_channel("encoder"), "needs encoders"}},
      .free_base = {},
      .present_base = std::move(present)};
}

}  // namespace

std::unique_ptr<Predictor> make_robot_predictor(const Dataset& dataset, const Candidate& nominal,
                                                const PredictOptions& options) {
  return std::make_unique<RigPredictor<RobotRig>>(dataset, nominal, options);
}

}  // namespace omnihil
