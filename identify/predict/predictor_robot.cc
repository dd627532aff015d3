#include "identify/predict/predictor_robot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identify/predict/robot_motion.h"
#include "identify/predict/robot_signals.h"
#include "sim/law/random.h"
#include "sim/model/rolling_model.h"

namespace omnihil {
namespace {

Candidate of_run(const Candidate& candidate, const Run& run) {
  return run.known.empty() ? candidate : with_known(candidate, run.known);
}

class RobotPredictor : public Predictor {
 public:
  RobotPredictor(const Dataset& dataset, const Candidate& nominal, const PredictOptions& options)
      : dataset_(dataset), nominal_(nominal), options_(options) {
    motion_.slave_angle = options.slave_angle;
    motion_.firmware = dataset_.firmware.get();
    if (dataset_.firmware)
      tick_s_ = 1e-9 * static_cast<double>(dataset_.firmware->fresh()->control_period_ns());
    for (const Run& run : dataset_.runs) {
      records_.push_back(robot_record(dataset_, run, rolling_params(of_run(nominal, run).file.parameters)));
      signals_.push_back(robot_signals(dataset_, run, records_.back()));
      add_input_noise(of_run(nominal, run), records_.back(), signals_.back());
      compared_.emplace_back();
      for (const RobotSignal& s : signals_.back()) compared_.back().push_back(s.compared);
    }
  }

  Method method() const override { return Method::kForward; }
  int run_count() const override { return static_cast<int>(dataset_.runs.size()); }
  const Run& run(int r) const override { return dataset_.runs[static_cast<std::size_t>(r)]; }
  const std::vector<ComparedSignal>& compared(int r) const override {
    return compared_[static_cast<std::size_t>(r)];
  }

  std::vector<RegimeTrack> regimes(const Candidate& candidate, int r) const override {
    const auto n = static_cast<std::size_t>(r);
    const auto model = robot_values<double>(of_run(candidate, run(r)), {}, 0);
    return robot_regimes(run(r), records_[n], run_robot(model, records_[n], motion_));
  }

  Prediction predict(const Candidate& candidate, int r) const override {
    const auto n = static_cast<std::size_t>(r);
    const auto model = robot_values<double>(of_run(candidate, run(r)), {}, 0);
    const RobotMotion<double> motion = run_robot(model, records_[n], motion_);
    Prediction out;
    out.finite = motion.finite;
    for (const RobotSignal& s : signals_[n])
      out.values.push_back(robot_signal_values(s, records_[n], motion));
    return out;
  }

  Prediction predict_with_derivatives(const Candidate& candidate, std::span<const Unknown> unknowns,
                                      int r) const override {
    if (unknowns.empty()) return predict(candidate, r);
    const auto n = static_cast<std::size_t>(r);
    const Candidate here = of_run(candidate, run(r));
    const std::vector<Unknown> open = open_unknowns(unknowns, run(r));
    if (motion_.firmware != nullptr && records_[n].radio) return by_differences(here, open, n);
    Prediction out;
    for (std::size_t first = 0; first < open.size(); first += kJetWidth) {
      const auto model = robot_values<Jet>(here, open, first);
      const RobotMotion<Jet> motion = run_robot(model, records_[n], motion_);
      out.finite = out.finite && motion.finite;
      const std::size_t count = std::min<std::size_t>(kJetWidth, open.size() - first);
      for (std::size_t s = 0; s < signals_[n].size(); ++s) {
        const std::vector<Jet> y = robot_signal_values(signals_[n][s], records_[n], motion);
        if (first == 0) {
          out.derivatives.emplace_back(y.size(), unknowns.size());
          out.values.emplace_back(y.size());
        }
        for (std::size_t k = 0; k < y.size(); ++k) {
          out.values[s][k] = y[k].a;
          for (std::size_t u = 0; u < count; ++u) {
            out.derivatives[s](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(first + u)) =
                y[k].v[static_cast<Eigen::Index>(u)];
          }
        }
      }
    }
    return out;
  }

  std::unique_ptr<Predictor> simulated(const Candidate& truth, std::uint64_t seed) const override;
  Capabilities capabilities() const override;

 private:
  Prediction values_of(const Candidate& here, std::size_t n) const {
    const RobotMotion<double> motion = run_robot(robot_values<double>(here, {}, 0), records_[n], motion_);
    Prediction out;
    out.finite = motion.finite;
    for (const RobotSignal& s : signals_[n])
      out.values.push_back(robot_signal_values(s, records_[n], motion));
    return out;
  }
  Prediction by_differences(const Candidate& here, std::span<const Unknown> unknowns, std::size_t n) const;
  void add_input_noise(const Candidate& model, const RobotRecord& record, std::vector<RobotSignal>& signals) {
    if (record.size() < 2 || (record.duty_quantum == 0.0 && record.bus_sigma_V == 0.0)) return;
    const auto values = robot_values<double>(model, {}, 0);
    const RobotMotion<double> motion = run_robot(values, record, motion_);
    const RobotMotion<double> other = run_robot(values, with_input_noise(record, kNoiseSeed), motion_);
    if (motion.finite && other.finite) omnihil::add_input_noise(record, motion, other, signals);
  }
  // Any: the draw is used for the rms of the noise floor alone.
  static constexpr std::uint64_t kNoiseSeed = 1;  // as above

  // Unknowns that the run states as known keep their index, but have no path: their derivatives are zero.
  static std::vector<Unknown> open_unknowns(std::span<const Unknown> unknowns, const Run& run) {
    std::vector<Unknown> open(unknowns.begin(), unknowns.end());
    for (Unknown& u : open) {
      for (const auto& [path, value] : run.known) {
        if (u.effect < 0 && u.path == path) u.path.clear();
      }
    }
    return open;
  }

  bool has_channel(std::string_view prefix) const {
    return std::any_of(dataset_.channels.begin(), dataset_.channels.end(),
                       [&](const Channel& c) { return c.signal.starts_with(prefix); });
  }

  Dataset dataset_;
  Candidate nominal_;
  PredictOptions options_;
  RobotMotionOptions motion_;
  double tick_s_ = 0.0;  // of the firmware
  std::vector<RobotRecord> records_;
  std::vector<std::vector<RobotSignal>> signals_;
  std::vector<std::vector<ComparedSignal>> compared_;
};

// Of a loop that is closed by a firmware nothing is known but its answers. It counts its encoders in whole counts and rounds its
// duties, so that a prediction is a staircase of a parameter: the difference is taken over a stretch that matters, and not over
// the least that a double has. Central, where bounds and a finite run let it.
Prediction RobotPredictor::by_differences(const Candidate& here, std::span<const Unknown> unknowns,
                                          std::size_t n) const {
  constexpr double kShare = 0.25;  // of the unknown's scale to either side: a choice
  Prediction out = values_of(here, n);
  for (const std::vector<double>& y : out.values) {
    out.derivatives.emplace_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(y.size()),
                                                       static_cast<Eigen::Index>(unknowns.size())));
  }
  if (!out.finite) return out;
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const Unknown& unknown = unknowns[u];
    if (unknown.path.empty()) continue;  // known in this run
    const std::optional<double> at = unknown.effect >= 0
                                         ? here.effects[static_cast<std::size_t>(unknown.effect)]
                                               .values[static_cast<std::size_t>(unknown.row)]
                                         : value_at(here, unknown.path);
    if (!at) continue;
    double step = kShare * unknown.scale;
    // A packet is heard at a tick, whichever moment between two it came at.
    if (unknown.path == "controller.latency_s") step = std::max(step, tick_s_);
    const auto beside = [&](double value) {
      const double held = std::clamp(value, unknown.lower, unknown.upper);
      return std::pair(
          held,
          held == *at ? out : values_of(with_values(here, std::span(&unknown, 1), std::span(&held, 1)), n));
    };
    auto [low, below] = beside(*at - step);
    auto [high, above] = beside(*at + step);
    if (!below.finite) low = *at, below = out;
    if (!above.finite) high = *at, above = out;
    if (!(high > low)) continue;
    for (std::size_t s = 0; s < out.values.size(); ++s) {
      for (std::size_t k = 0; k < out.values[s].size(); ++k) {
        out.derivatives[s](static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(u)) =
            (above.values[s][k] - below.values[s][k]) / (high - low);
      }
    }
  }
  return out;
}

std::unique_ptr<Predictor> RobotPredictor::simulated(const Candidate& truth, std::uint64_t seed) const {
  Dataset made = dataset_;
  std::vector<RobotMotion<double>> motions;
  const auto own_seed = [&](std::size_t n) { return mix_bits(seed ^ mix_bits(n)); };
  for (std::size_t n = 0; n < made.runs.size(); ++n) {
    RobotMotionOptions free = motion_;
    free.slave_angle = false;
    free.follow_camera = false;
    free.noise_seed = own_seed(n);
    const auto model = robot_values<double>(of_run(truth, made.runs[n]), {}, 0);
    // the true inputs: duties before rounding, bus voltage without its sensor's noise
    RobotRecord true_input = with_input_noise(records_[n], own_seed(n));
    true_input.bus_voltage_V = records_[n].bus_voltage_V;
    motions.push_back(run_robot(model, true_input, free));
    measure_robot(records_[n], motions.back(), signals_[n], own_seed(n), made.runs[n]);
  }
  auto null = std::make_unique<RobotPredictor>(made, nominal_, options_);
  for (std::size_t n = 0; n < made.runs.size(); ++n) {
    for (std::size_t s = 0; s < null->signals_[n].size(); ++s) {
      RobotSignal& signal = null->signals_[n][s];
      if (signal.output == RobotOutput::kBusVoltage) {
        measure_robot_bus(records_[n], motions[n], own_seed(n), signal);
        null->compared_[n][s] = signal.compared;
      }
      // the sensors are those of the recording: sigmas are not estimated anew
      signal.channel_sigma = signals_[n][s].channel_sigma;
      null->compared_[n][s].noise_sigma = compared_[n][s].noise_sigma;
      null->compared_[n][s].whitened_sigma = compared_[n][s].whitened_sigma;
    }
  }
  return null;
}

Capabilities RobotPredictor::capabilities() const {
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
  return std::make_unique<RobotPredictor>(dataset, nominal, options);
}

}  // namespace omnihil
