#include "identify/design/experiment_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "identify/predict/robot_motion.h"
#include "identify/record/rig.h"
#include "identify/record/statistics.h"
#include "sim/model/axis_model.h"
#include "sim/model/rolling_model.h"

namespace omnihil {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double median_or(const std::vector<double>& values, double otherwise) {
  const std::vector<double> finite = finite_values(values);
  return finite.empty() ? otherwise : median(finite);
}

double largest_of(const Dataset& given, const std::string& signal) {
  double largest = 0.0;
  for (const Run& run : given.runs) {
    const std::vector<double>* values = run.signal(signal);
    if (values != nullptr) largest = std::max(largest, largest_size(*values));
  }
  return largest;
}

double camera_period(const Run& run) {
  for (const char* name : {"vision_x", "vision_y", "vision_theta"}) {
    const std::vector<double>* pose = run.signal(name);
    if (pose == nullptr) continue;
    double first = kMissing, last = kMissing;
    int frames = 0;
    for (std::size_t k = 0; k < pose->size(); ++k) {
      if (!std::isfinite((*pose)[k])) continue;
      last = run.time_s[k];
      if (frames++ == 0) first = last;
    }
    if (frames > 1) return (last - first) / (frames - 1);
  }
  return 0.0;
}

// Sensor noise as estimated from the given data, where no channel states it.
void fill_noise(const Predictor& predictor, Dataset& like) {
  for (int r = 0; r < predictor.run_count(); ++r) {
    for (const ComparedSignal& c : predictor.compared(r)) {
      for (Channel& channel : like.channels) {
        if (channel.signal == c.name && channel.sigma <= 0.0 && channel.counts_per_rev <= 0.0) {
          channel.sigma = c.noise_sigma;
        }
      }
    }
  }
}

double bus_of(const PlannedBench& bench) {
  const std::vector<double>* bus = bench.example.signal("bus_voltage");
  return bus != nullptr ? median_or(*bus, bench.supply_V) : bench.supply_V;
}

// The run with its inputs; all measured signals zero so far (bus voltage: at its level).
Run blank_run(const PlannedBench& bench, const PlannedInputs& inputs) {
  Run run;
  run.file = "planned";
  run.split = Split::kTraining;
  run.time_s = inputs.time_s;
  const std::size_t n = run.time_s.size();
  const double bus_V = bus_of(bench);
  for (const auto& [name, values] : bench.example.signals) {
    const SignalRow* row = find_signal(*bench.like.rig, name);
    const bool drive = row != nullptr && row->role == SignalRole::kDrive;
    if (drive && name != "dribbler") continue;
    double level = name == "enable" ? 1.0 : 0.0;
    if (name == "bus_voltage") level = bus_V;
    run.signals[name].assign(n, level);
    if (!name.starts_with("vision") || bench.camera_period_s <= 0.0) continue;
    double next_s = run.time_s.front();
    for (std::size_t k = 0; k < n; ++k) {
      const bool frame = run.time_s[k] >= next_s - 1e-9;
      run.signals[name][k] = frame ? 0.0 : kMissing;
      if (frame) next_s += bench.camera_period_s;
    }
  }
  for (std::size_t i = 0; i < bench.inputs.size(); ++i) run.signals[bench.inputs[i]] = inputs.drive[i];
  return run;
}

Dataset with_run(const Dataset& like, Run run) {
  Dataset dataset = like;
  dataset.runs = {std::move(run)};
  return dataset;
}

// Displacement from speed, and counts of an encoder that turns through it.
void turn_through(const PlannedBench& bench, const std::vector<double>& speed, double gear_ratio, Run& run) {
  double at = 0.0;
  std::vector<double> displacement(run.time_s.size(), 0.0);
  for (std::size_t k = 1; k < displacement.size(); ++k) {
    if (std::isfinite(speed[k])) at += speed[k] * (run.time_s[k] - run.time_s[k - 1]);
    displacement[k] = at;
  }
  if (auto position = run.signals.find("position"); position != run.signals.end())
    position->second = displacement;
  const Channel* encoder = bench.like.channel("encoder");
  if (encoder == nullptr || !run.signals.contains("encoder")) return;
  const double per_rad = encoder->counts_per_rev / kTurn * (encoder->on_output ? 1.0 : gear_ratio);
  for (std::size_t k = 0; k < displacement.size(); ++k)
    run.signals["encoder"][k] = std::floor(displacement[k] * per_rad);
}

// Takes an axis' simulated response as its measurement; positions and counts are the integral of its speed,
// so that laws of the angle are given an angle.
void measure_axis(const PlannedBench& bench, const Predictor& simulated, const Candidate& truth, Run& run) {
  const Prediction y = simulated.predict(truth, 0);
  const std::vector<ComparedSignal>& compared = simulated.compared(0);
  const DriveParams<double> drive = drive_of(truth);
  for (std::size_t s = 0; s < compared.size(); ++s) {
    if (auto own = run.signals.find(compared[s].name);
        own != run.signals.end() && compared[s].name != "bus_voltage") {
      own->second = y.values[s];
      for (double& v : own->second) v = std::isfinite(v) ? v : 0.0;
    }
    if (compared[s].name != "velocity" && compared[s].name != "encoder_velocity") continue;
    turn_through(bench, y.values[s], drive.gear_ratio, run);
  }
}

// The run of a bench that imposes the motion; its torque or current is what the models are asked for.
Run imposed_run(const PlannedBench& bench, const PlannedInputs& inputs) {
  Run run = blank_run(bench, inputs);
  const std::vector<double> speed = imposed_speed(bench, inputs);
  for (const auto& [name, values] : bench.example.signals) {
    const SignalRow* row = find_signal(*bench.like.rig, name);
    if (row != nullptr && row->role == SignalRole::kDrive) run.signals[name].assign(run.time_s.size(), 0.0);
  }
  if (auto own = run.signals.find("velocity"); own != run.signals.end()) own->second = speed;
  turn_through(bench, speed, drive_of(bench.nominal).gear_ratio, run);
  return run;
}

// Largest speed, acceleration and travel of the given motion.
void fill_motion(const Dataset& given, const Predictor& predictor, const Candidate& nominal,
                 PlannedBench& bench) {
  constexpr double kAcceleration =
      0.99;  // quantile: the largest ones are the sensor's noise, differentiated twice; a choice
  bench.full_input = 0.0;
  std::vector<double> accelerations;
  for (int r = 0; r < predictor.run_count(); ++r) {
    for (const RegimeTrack& track : predictor.regimes(nominal, r)) {
      const bool speed = track.name == "velocity", acceleration = track.name == "acceleration";
      for (const double v : track.value) {
        if (!std::isfinite(v)) continue;
        if (speed) bench.full_input = std::max(bench.full_input, std::abs(v));
        if (acceleration) accelerations.push_back(std::abs(v));
      }
    }
  }
  if (!accelerations.empty())
    bench.most_acceleration = quantile(std::move(accelerations), kAcceleration, QuantileRank::kLower);
  for (const Run& run : given.runs) {
    const std::vector<double>* position = run.signal("position");
    if (position == nullptr || position->empty()) continue;
    for (const double x : *position) {
      if (std::isfinite(x)) bench.most_travel = std::max(bench.most_travel, std::abs(x - position->front()));
    }
  }
}

}  // namespace

PlannedBench planned_bench(const Dataset& given, const Candidate& nominal, const Predictor& predictor) {
  PlannedBench bench{
      .like = given, .example = {}, .nominal = nominal, .inputs = {}, .input_scale = {}, .problem = {}};
  bench.like.runs.clear();
  for (const Run& run : given.runs) {
    if (run.split == Split::kTraining && !run.steady) {
      bench.example = run;
      break;
    }
  }
  if (predictor.method() == Method::kInverse) {
    bench.imposed = true;
    bench.inputs = {"velocity"};
    fill_motion(given, predictor, nominal, bench);
    fill_noise(predictor, bench.like);
    if (bench.example.time_s.empty() || bench.full_input <= 0.0 || bench.most_acceleration <= 0.0)
      bench.problem = "no run of use \"fit\" is a time series in which this bench moves";
    return bench;
  }
  if (!given.rig->no_plan.empty()) {
    bench.problem = given.rig->no_plan;
    return bench;
  }
  bench.supply_V = nominal.file.parameters.value_or("supply.voltage_V", 0.0);
  const bool robot = given.rig->whole_robot;
  const bool by_duty = bench.example.signal("duty_1") != nullptr;
  if (robot && !by_duty && bench.example.signal("command_vx") != nullptr) {
    bench.inputs = {"command_vx", "command_vy", "command_w"};
    bench.full_input = std::max(largest_of(given, "command_vx"), largest_of(given, "command_vy"));
    // A turn at an excitation's value of 1 moves the rim as fast as a drive at 1.
    const double radius_m = rolling_params(nominal.file.parameters).wheel_center_radius_m;
    bench.input_scale = {1.0, 1.0, 1.0 / std::max(radius_m, 1e-3)};
  } else if (robot && !by_duty && bench.example.signal("command_wheel_1") != nullptr) {
    bench.inputs = per_wheel("command_wheel", wheel_count(nominal.file.parameters));
    bench.full_input = 0.0;
    for (const std::string& input : bench.inputs)
      bench.full_input = std::max(bench.full_input, largest_of(given, input));
  } else if (robot) {
    bench.inputs = per_wheel("duty", wheel_count(nominal.file.parameters));
  } else {
    for (const char* name : {"duty", "motor_voltage", "position_target"}) {
      if (bench.example.signal(name) != nullptr) bench.inputs = {name};
    }
  }
  if (bench.inputs.empty() || bench.example.time_s.empty()) {
    bench.problem = "no run of use \"fit\" that is a time series driven by duty, voltage or position";
    return bench;
  }
  if (bench.inputs.front() == "motor_voltage") bench.full_input = bench.supply_V;
  if (bench.inputs.front() == "position_target") bench.full_input = largest_of(given, "position_target");
  for (const std::string& input : bench.inputs) {
    if (bench.like.channel(input) == nullptr)
      bench.like.channels.push_back({.signal = input, .column = input, .unit = "1"});
  }
  bench.camera_period_s = camera_period(bench.example);
  fill_noise(predictor, bench.like);
  return bench;
}

std::vector<double> imposed_speed(const PlannedBench& bench, const PlannedInputs& inputs) {
  std::vector<double> speed(inputs.time_s.size(), 0.0);
  for (std::size_t k = 1; k < speed.size(); ++k) {
    const double most = bench.most_acceleration * (inputs.time_s[k] - inputs.time_s[k - 1]);
    speed[k] = speed[k - 1] + std::clamp(inputs.drive[0][k] - speed[k - 1], -most, most);
  }
  return speed;
}

std::unique_ptr<Predictor> simulated_truth(const PlannedBench& bench, const PlannedInputs& inputs,
                                           const Candidate& truth, std::uint64_t seed) {
  if (bench.imposed)
    return make_predictor(with_run(bench.like, imposed_run(bench, inputs)), bench.nominal, {});
  Run run = blank_run(bench, inputs);
  if (bench.like.rig->whole_robot) {
    return make_predictor(with_run(bench.like, run), bench.nominal, {})->simulated(truth, seed);
  }
  const auto free = make_predictor(with_run(bench.like, run), bench.nominal, {.slave_angle = false});
  measure_axis(bench, *free, truth, run);
  return make_predictor(with_run(bench.like, run), bench.nominal, {});
}

MotionExtremes planned_extremes(const PlannedBench& bench, const PlannedInputs& inputs,
                                const Candidate& model) {
  MotionExtremes out;
  if (bench.like.rig->whole_robot) {
    const Dataset dataset = with_run(bench.like, blank_run(bench, inputs));
    const RobotRecord record =
        robot_record(dataset, dataset.runs[0], rolling_params(bench.nominal.file.parameters));
    RobotMotionOptions options;
    options.slave_angle = options.follow_camera = false;
    options.firmware = bench.like.firmware.get();
    const RobotMotion<double> m = run_robot(rolling_values<double>({model}), record, options);
    out.finite = m.finite;
    for (std::size_t k = 1; k < record.size(); ++k) {
      const RollingSample<double>&now = m.samples[k], &before = m.samples[k - 1];
      out.travel = std::max(out.travel, std::hypot(now.pose[0], now.pose[1]));
      const double dt_s = record.time_s[k] - record.time_s[k - 1];
      for (std::size_t i = 0; i < record.wheels; ++i) {
        out.current_A = std::max(out.current_A, std::abs(now.current_A[i]));
        const double speed = std::abs(now.encoder_rad[i] - before.encoder_rad[i]) / dt_s;
        out.rotor_speed_rad_s = std::max(out.rotor_speed_rad_s, speed);
      }
    }
    return out;
  }
  if (bench.imposed) {
    const std::vector<double> speed = imposed_speed(bench, inputs);
    const double gear = bench.like.linear ? 1.0 : drive_of(model).gear_ratio;
    double at = 0.0;
    for (std::size_t k = 1; k < speed.size(); ++k) {
      at += speed[k] * (inputs.time_s[k] - inputs.time_s[k - 1]);
      out.rotor_speed_rad_s = std::max(out.rotor_speed_rad_s, std::abs(speed[k]) * gear);
      out.travel = std::max(out.travel, std::abs(at));
    }
    return out;
  }
  // Speed and current are simulated whether or not the bench measures them.
  PlannedBench all = bench;
  for (const char* name : {"velocity", "motor_current"}) {
    all.example.signals[name] = {};
    if (all.like.channel(name) == nullptr)
      all.like.channels.push_back({.signal = name, .column = name, .unit = "", .sigma = 1.0});
  }
  const auto simulated =
      make_predictor(with_run(all.like, blank_run(all, inputs)), bench.nominal, {.slave_angle = false});
  const Prediction y = simulated->predict(model, 0);
  out.finite = y.finite;
  const double gear = bench.like.linear ? 1.0 : drive_of(model).gear_ratio;
  double at = 0.0;
  for (std::size_t s = 0; s < simulated->compared(0).size(); ++s) {
    const std::string& name = simulated->compared(0)[s].name;
    for (std::size_t k = 1; k < y.values[s].size(); ++k) {
      const double v = y.values[s][k];
      if (!std::isfinite(v)) continue;
      if (name == "motor_current") out.current_A = std::max(out.current_A, std::abs(v));
      if (name != "velocity") continue;
      out.rotor_speed_rad_s = std::max(out.rotor_speed_rad_s, std::abs(v) * gear);
      at += v * (inputs.time_s[k] - inputs.time_s[k - 1]);
      out.travel = std::max(out.travel, std::abs(at));
    }
  }
  return out;
}

}  // namespace omnihil
