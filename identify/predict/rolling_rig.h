// Rigs on wheels that roll on a floor, as a predictor has them (predictor_rig.h): records, signals, noise and null of any
// of them. A kind says which.
#pragma once
#include <algorithm>
#include <concepts>
#include <memory>
#include <utility>
#include <vector>

#include "identify/predict/camera_path.h"
#include "identify/predict/predictor_rig.h"
#include "identify/predict/robot_motion.h"
#include "identify/predict/robot_signals.h"
#include "sim/law/random.h"

namespace omnihil {

// What it makes of a robot's parameters, what effects may need of it, and whether its derivatives on tyres may be those of
// steps twice as long (a body's speed follows its wheels slowly; a single wheel's force does not).
template <class K>
concept RollingKind = requires(const RollingParams<double>& robot, const RollingParams<Jet>& jets,
                               const Dataset& dataset) {
  { K::params(robot) } -> std::same_as<RollingParams<double>>;
  { K::params(jets) } -> std::same_as<RollingParams<Jet>>;
  { K::capabilities(dataset) } -> std::same_as<Capabilities>;
  { K::kRough } -> std::convertible_to<bool>;
};

template <RollingKind Kind>
class RollingRig : public RigRuns<RobotRun> {
 public:
  static constexpr bool kCostly = true;
  // `noise_of`: sensors whose noise is known, run by run; null: it is found here.
  RollingRig(std::shared_ptr<const Dataset> dataset, std::shared_ptr<const Candidate> nominal,
             const PredictOptions& options, const std::vector<RobotRun>* noise_of = nullptr)
      : RigRuns(std::move(dataset), std::move(nominal), options) {
    motion_.slave_angle = options.slave_angle;
    motion_.firmware = dataset_->firmware.get();
    if (dataset_->firmware)
      tick_s_ = 1e-9 * static_cast<double>(dataset_->firmware->fresh()->control_period_ns());
    for (const Run& run : dataset_->runs) {
      const Candidate model = with_known(*nominal_, run.known);
      runs_.push_back(robot_run(*dataset_, run, Kind::params(rolling_params(model.file.parameters))));
    }
    share_noise(all_runs());
    for (std::size_t n = 0; n < runs_.size(); ++n) {
      if (noise_of != nullptr)
        keep_sensors((*noise_of)[n], runs_[n]);
      else
        add_input_noise(with_known(*nominal_, dataset_->runs[n].known), runs_[n]);
    }
  }

  double step_s(const Candidate&, std::size_t) const { return kRollingStep_s; }
  // Of a loop that is closed by a firmware nothing is known but its answers.
  bool is_exact(const Candidate&, std::size_t n) const {
    return motion_.firmware == nullptr || !runs_[n].record.radio;
  }
  // Wheels on tyres, with derivatives: at twice the step these are off by a hundredth, which costs a fit no iteration.
  bool is_rough(const Candidate& own, std::size_t) const {
    return Kind::kRough && rolling_params(own.file.parameters).has_tyre;
  }
  std::vector<RegimeTrack> regimes(const Candidate& own, std::size_t n) const {
    return robot_regimes(dataset_->runs[n], runs_[n].record,
                         run_robot(values_of<double>({own}), runs_[n].record, motion_));
  }

  template <typename T>
  RigOutputs<T> outputs(const RigModel& model, std::size_t n, double) const {
    if constexpr (std::is_same_v<T, double>) {
      if (is_deaf(model.candidate, n)) return seen_outputs(model.candidate, n);
    }
    RobotMotionOptions how = motion_;
    how.rough = Kind::kRough && std::is_same_v<T, Jet>;
    const RobotMotion<T> motion = run_robot(values_of<T>(model), runs_[n].record, how);
    return {.values = robot_outputs(runs_[n], motion), .finite = motion.finite};
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
  Capabilities capabilities() const {
    Capabilities out = Kind::capabilities(*dataset_);
    for (const RobotRun& run : runs_)
      out.loop_period_s = std::max(out.loop_period_s, run.record.loop_period_s);
    return out;
  }

 private:
  // Driven by commands alone, and no law looks at a sensor, its clock or the measured heading: it moves the same whatever the
  // sensors' noise, so that all replicates of a null (null_model.h) are readings of one motion.
  bool is_deaf(const Candidate& own, std::size_t n) const {
    const RobotRecord& r = runs_[n].record;
    if (!r.radio || motion_.firmware != nullptr || r.has_all_encoders || !r.bus.input_V.empty() ||
        !r.imposed_velocity.empty() || !r.settled.empty() || r.duty_quantum != 0.0)
      return false;
    return std::ranges::none_of(own.effects, [](const EffectUse& use) {
      const ApplyFunctions<double>& acts = use.entry->simulate;
      return acts.body != nullptr || acts.sensor != nullptr || acts.timing != nullptr;
    });
  }
  // Of a deaf robot: its motion, on its own path.
  std::shared_ptr<const RobotMotion<double>> own_motion(const Candidate& own, std::size_t n) const {
    const BodyVelocity<double>& start = runs_[n].record.start_velocity;
    SimulatedNumbers key = simulated_numbers(own, n);
    key.numbers.insert(key.numbers.end(), {start.v_forward_m_s, start.v_left_m_s, start.omega_body_rad_s});
    return motions_->of(std::move(key), [&] {
      RobotMotionOptions how = motion_;
      how.follow_camera = false;
      return run_robot(values_of<double>({own}), runs_[n].record, how);
    });
  }
  RigOutputs<double> seen_outputs(const Candidate& own, std::size_t n) const {
    RobotMotion<double> motion = *own_motion(own, n);
    const double age_s = 0.0;  // no law of timing acts
    for (RollingSample<double>& s : motion.samples) s.pose = {};
    const std::vector<double> heading = headings(runs_[n].record, age_s);
    see_path(runs_[n].record, {true, age_s, heading}, motion.samples);
    return {.values = robot_outputs(runs_[n], motion), .finite = motion.finite};
  }

  template <typename T>
  static RobotModelValues<T> values_of(const RigModel& model) {
    auto values = rolling_values<T>(model);
    values.params = Kind::params(values.params);
    return values;
  }
  void add_input_noise(const Candidate& model, RobotRun& run) {
    const RobotRecord& record = run.record;
    if (record.size() < 2 || (record.duty_quantum == 0.0 && record.bus.sigma_V == 0.0)) return;
    const auto values = values_of<double>({model});
    const RobotMotion<double> motion = run_robot(values, record, motion_);
    const RobotMotion<double> other = run_robot(values, with_input_noise(record, kNoiseSeed), motion_);
    if (motion.finite && other.finite) omnihil::add_input_noise(motion, other, run);
  }
  // Any: the draw is used for the rms of the noise floor alone.
  static constexpr std::uint64_t kNoiseSeed = 1;  // as above

  RobotMotionOptions motion_;
  using Motions = Remembered<SimulatedNumbers, RobotMotion<double>>;
  static constexpr std::size_t kMotions = 2;  // of each run: of the two fits that go on at a time; a choice
  std::shared_ptr<Motions> motions_ = std::make_shared<Motions>(kMotions * dataset_->runs.size());
  double tick_s_ = 0.0;  // of the firmware
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
    RobotRecord true_input = with_input_noise(runs_[n].record, own_seed(n));
    true_input.bus = runs_[n].record.bus;
    motions.push_back(is_deaf(own, n) ? *own_motion(own, n)
                                      : run_robot(values_of<double>({own}), true_input, free));
    measure_robot(runs_[n], motions.back(), own_seed(n), made->runs[n]);
  }
  const std::shared_ptr<Motions> shared = motions_;
  *this = RollingRig(std::move(made), nominal_, options_, &runs_);
  motions_ = shared;
  for (std::size_t n = 0; n < runs_.size(); ++n) measure_compared_bus(motions[n], own_seed(n), runs_[n]);
}

inline bool has_channel(const Dataset& dataset, std::string_view prefix) {
  return std::any_of(dataset.channels.begin(), dataset.channels.end(),
                     [&](const Channel& c) { return c.signal.starts_with(prefix); });
}

// What rigs on wheels have in common: drives by duty from one bus, and no shaft between rotor and wheel. Base parameters
// exclude no effect: what a tolerance of an inductance trades with is for the fit to say.
inline Capabilities rolling_capabilities(bool body_is_free, std::uint32_t more) {
  constexpr std::uint32_t kAlways =
      kNeedsFloor | kNeedsSupply | kNeedsWinding | kNeedsDuty | kNeedsVoltage | kNeedsSimulation;
  return {.rig = kOnRobot,
          .other_rig = "acts on a single axis",
          .list = {{kAlways | more, true, ""},
                   {kNeedsFreeBody, body_is_free, "the bench moves the body, whatever forces do"},
                   {kNeedsTwoInertias, false,
                    "needs a freedom between rotor and wheel, which a robot's model lacks"},
                   {kNeedsPositionServo, false, "needs a position servo"},
                   {kNeedsReportedSpeed, false, "needs a speed that the drive's electronics estimate"}},
          .free_base = {},
          .present_base = {}};
}

}  // namespace omnihil
