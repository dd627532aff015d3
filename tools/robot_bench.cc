#include "tools/robot_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hil/dataset/dataset_model.h"
#include "hil/loop/effect_overrides.h"
#include "hil/text/program_files.h"
#include "hil/text/recording_text.h"
#include "sim/bench/excitation.h"
#include "sim/drive/sensor_chain.h"
#include "sim/law/random.h"
#include "sim/model/model_writer.h"
#include "sim/robot/plant.h"

namespace omnihil {
namespace {

constexpr double kHoldoutRatio = 1.0 / 3.0;  // of a file's time, at its end
constexpr double kHoldoutAmplitude = 0.8;    // of the fit run's
constexpr double kCamera_Hz = 60.0;          // rate of the league's vision
constexpr std::int64_t kStep_ns = 500'000;   // of the mechanics

// 1-sigma of usual sensors (guesses, +-50 %), in the order of the columns.
constexpr double kBus_V = 0.02, kCurrent_A = 0.03, kGyro_rad_s = 0.01, kAccel_m_s2 = 0.1, kVision_m = 0.001,
                 kVision_rad = 0.005;

using Duties = PerWheel<double>;

struct Run {
  std::string name, use, excitation;
  std::vector<Duties> duty;  // one per sample
  std::uint64_t seed = 0;
};

// Duties of a body motion, scaled so that no wheel exceeds 1: rim speeds of eq. (5) with R_b = 1.
Duties duties_of(const RobotModel& m, double forward, double left, double turn) {
  Duties d{};
  double most = 1.0;
  for (std::size_t i = 0; i < m.wheels; ++i) {
    const double a = m.wheel_angle_rad[i];
    d[i] = -std::sin(a) * forward + std::cos(a) * left + turn;
    most = std::max(most, std::abs(d[i]));
  }
  for (double& x : d) x /= most;
  return d;
}

// Largest change of a duty in a second that a tyre follows without skidding: half of what its grip can accelerate, over the
// rim's speed at full duty. A robot that skids shows its floor and little else.
double gentle_slew_per_s(const RobotModel& m) {
  const double full_m_s =
      m.bus_voltage_V / (m.motor.torque_constant_Nm_per_A * m.gear_ratio) * m.wheel_radius_m;
  return 0.5 * m.tyre_longitudinal.extremum_value * 9.81 / full_m_s;
}

std::vector<Duties> excited(Excitation kind, const RobotModel& m, const BenchOptions& o, double scale,
                            std::uint64_t seed) {
  std::vector<Duties> out;
  const auto count = static_cast<std::size_t>(o.duration_s * o.rate_Hz + 1e-6) + 1;
  const double most = gentle_slew_per_s(m) / o.rate_Hz;
  for (std::size_t n = 0; n < count; ++n) {
    const double t = static_cast<double>(n) / o.rate_Hz;
    const auto one = [&](std::uint64_t which) {
      return excitation_at(kind, t, {.duration_s = o.duration_s, .seed = mix_bits(3 * seed + which)});
    };
    // patterns without a seed (ramp, chirp) would be one motion: each third has its own direction
    const bool seeded = kind == Excitation::kSteps || kind == Excitation::kPrbs;
    const double third = 3.0 * t / o.duration_s;
    const auto part = [&](double from) { return third >= from && third < from + 1.0 ? 1.0 : 0.0; };
    const double x = seeded ? 0.6 * one(0) : one(0) * part(0), y = seeded ? 0.6 * one(1) : one(0) * part(1);
    const double w = seeded ? 0.4 * one(2) : one(0) * part(2);
    Duties d = duties_of(m, x, y, w);
    for (std::size_t i = 0; i < m.wheels; ++i) {
      const double before = out.empty() ? 0.0 : out.back()[i];
      d[i] = before + std::clamp(d[i] * o.amplitude * scale - before, -most, most);
    }
    out.push_back(d);
  }
  return out;
}

// Rows of a CSV file, held to the rate of the run. The first line may be a header.
std::vector<Duties> read_file(const std::string& path, const RobotModel& m, const BenchOptions& o,
                              std::vector<std::string>& faults) {
  std::vector<Duties> out;
  std::ifstream file(path);
  if (!file) faults.push_back(fmt::format("--excite {}: cannot be read", path));
  std::string line;
  double last_s = -1.0;
  for (int number = 1; std::getline(file, line) && faults.size() < 20; ++number) {
    std::istringstream cells(line);
    std::vector<double> values;
    bool good = true;
    for (std::string cell; std::getline(cells, cell, ',');) {
      while (!cell.empty() && (cell.back() == '\r' || cell.back() == ' ')) cell.pop_back();
      cell.erase(0, cell.find_first_not_of(' '));
      values.push_back(0.0);
      good = parse_number(cell, values.back()) && good;
    }
    if (!good && number == 1) continue;
    if (values.empty()) continue;
    if (!good || (values.size() != 2 && values.size() != m.wheels + 1) || values[0] <= last_s) {
      faults.push_back(fmt::format("{}:{}: \"{}\": needed are a time that increases and one or {} duties",
                                   path, number, line, m.wheels == 4 ? "four" : std::to_string(m.wheels)));
      continue;
    }
    last_s = values[0];
    Duties now{};
    if (values.size() == 2)
      now = duties_of(m, values[1], 0, 0);
    else
      std::copy(values.begin() + 1, values.end(), now.begin());
    const auto upto = static_cast<std::size_t>(std::max(0.0, last_s) * o.rate_Hz + 0.5);
    while (out.size() < upto && !out.empty()) out.push_back(out.back());
    out.push_back(now);
  }
  if (out.size() < 3 && faults.empty())
    faults.push_back(fmt::format("--excite {}: fewer than three rows", path));
  return out;
}

std::vector<Run> runs_of(const BenchOptions& o, const RobotModel& m, std::vector<std::string>& faults) {
  std::vector<Run> runs;
  for (const std::string& e : o.excitations) {
    if (const auto kind = find_excitation(e)) {
      runs.push_back({e, "fit", e, excited(*kind, m, o, 1.0, o.seed), 0});
      runs.push_back({e + "_holdout", "holdout", e, excited(*kind, m, o, kHoldoutAmplitude, o.seed + 1), 0});
      continue;
    }
    if (e.find('.') == std::string::npos && !std::filesystem::exists(e)) {
      faults.push_back(
          fmt::format("--excite {}: allowed are {}, or a CSV file", e, fmt::join(excitation_names(), ", ")));
      continue;
    }
    const std::vector<Duties> all = read_file(e, m, o, faults);
    const auto cut = static_cast<std::ptrdiff_t>(static_cast<double>(all.size()) * (1.0 - kHoldoutRatio));
    const std::string stem = std::filesystem::path(e).stem().string();
    runs.push_back({stem, "fit", e, {all.begin(), all.begin() + cut}, 0});
    runs.push_back({stem + "_holdout", "holdout", e, {all.begin() + cut, all.end()}, 0});
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].seed = mix_bits(o.seed + i);
    for (std::size_t j = 0; j < i; ++j) {
      if (runs[i].name == runs[j].name)
        faults.push_back(fmt::format("--excite {}: given twice", runs[i].name));
    }
  }
  return runs;
}

std::string dataset_text(const BenchOptions& o, const RobotModel& m, const std::vector<Run>& runs) {
  const auto channel = [&](const std::string& signal, const std::string& column, double sigma) {
    return sigma * o.noise_scale > 0.0 ? fmt::format("{} = {{ column = \"{}\", sigma = {:g} }}\n", signal,
                                                     column, sigma * o.noise_scale)
                                       : fmt::format("{} = {{ column = \"{}\" }}\n", signal, column);
  };
  std::string text = fmt::format(
      "format = \"omnihil-dataset/1\"\ntitle = {}\nrig = \"robot\"\nmodel = \"model.toml\"\n\n[channels]\n",
      toml_text("simulated: " + o.model));
  text += channel("time", "time_s", 0);
  for (std::size_t i = 1; i <= m.wheels; ++i)
    text += channel(fmt::format("duty_{}", i), fmt::format("duty_{}", i), 0);
  text += channel("bus_voltage", "bus_V", kBus_V);
  for (std::size_t i = 1; i <= m.wheels; ++i) {
    text += channel(fmt::format("motor_current_{}", i), fmt::format("current_{}", i), kCurrent_A);
    text +=
        fmt::format("encoder_{} = {{ column = \"ticks_{}\", counts_per_rev = {}, shaft = \"rotor\"{} }}\n", i,
                    i, m.encoder.counts_per_turn, m.encoder.direction < 0 ? ", scale = -1" : "");
  }
  text += channel("gyro_z", "gyro_z", kGyro_rad_s);
  text += channel("accel_x", "accel_x", kAccel_m_s2) + channel("accel_y", "accel_y", kAccel_m_s2);
  text += channel("vision_x", "vision_x", kVision_m) + channel("vision_y", "vision_y", kVision_m);
  text += channel("vision_theta", "vision_theta", kVision_rad);
  for (const Run& run : runs) {
    text += fmt::format("\n[[runs]]\nfile = {}\nuse = \"{}\"\nexcitation = {}\n",
                        toml_text(run.name + ".csv"), run.use, toml_text(run.excitation));
  }
  return text;
}

// Drives the robot through one run; the CSV so far when the plant diverged.
std::string run_csv(const BenchOptions& o, const RobotModel& m, const Run& run, std::string& diverged) {
  PlantOptions options;
  options.physics = Physics::kPlanar;
  options.mechanical_step_ns = kStep_ns;
  options.seed = run.seed;
  Plant plant(std::vector<RobotModel>{m}, options);
  const std::int64_t period_ns = std::llround(1e9 / o.rate_Hz);
  std::string text = "time_s";
  for (std::size_t i = 1; i <= m.wheels; ++i) text += fmt::format(",duty_{}", i);
  text += ",bus_V";
  for (std::size_t i = 1; i <= m.wheels; ++i) text += fmt::format(",current_{0},ticks_{0}", i);
  text += ",gyro_z,accel_x,accel_y,vision_x,vision_y,vision_theta\n";
  std::int64_t last_frame = -1;
  for (std::size_t k = 0; k < run.duty.size(); ++k) {
    const PlantSensors all = plant.sample_all(0);
    const RobotSensors& s = all.board;
    const auto measured = [&](double value, double sigma, std::string_view stream) {
      return noisy(value, sigma * o.noise_scale, run.seed, stream, k);
    };
    const double time_s = static_cast<double>(plant.now_ns()) * 1e-9;
    text += fmt::format("{:.6f}", time_s);
    for (std::size_t i = 0; i < m.wheels; ++i) text += fmt::format(",{:.9g}", run.duty[k][i]);
    text += fmt::format(",{:.4f}", measured(s.bus_voltage_V, kBus_V, "bus_voltage"));
    for (std::size_t i = 0; i < m.wheels; ++i) {
      const std::string stream = fmt::format("motor_current_{}", i);
      text += fmt::format(",{:.5f},{}", measured(all.motor_current_A[i], kCurrent_A, stream),
                          all.encoder_counts[i]);
    }
    text += fmt::format(",{:.5f},{:.5f},{:.5f}", measured(s.gyro_z_rad_s, kGyro_rad_s, "gyro_z"),
                        measured(s.accel_x_m_s2, kAccel_m_s2, "accel_x"),
                        measured(s.accel_y_m_s2, kAccel_m_s2, "accel_y"));
    // the first row at or after each camera frame carries it
    const auto frame = static_cast<std::int64_t>(std::floor(time_s * kCamera_Hz + 1e-9));
    if (frame != last_frame) {
      const VisionPose p = plant.vision(0);
      text += fmt::format(",{:.6f},{:.6f},{:.6f}\n", measured(p.x_m, kVision_m, "vision_x"),
                          measured(p.y_m, kVision_m, "vision_y"),
                          measured(p.yaw_rad, kVision_rad, "vision_theta"));
    } else {
      text += ",,,\n";
    }
    last_frame = frame;
    plant.write_duties(0, run.duty[k]);
    if (k + 1 < run.duty.size()) plant.advance(period_ns);
    if (plant.fault()) {
      diverged = fmt::format("run {}: {} {} is not finite at {:.6f} s", run.name, plant.fault()->signal,
                             plant.fault()->index + 1, time_s);
      break;
    }
  }
  return text;
}

void check_numbers(const BenchOptions& o, std::vector<std::string>& faults) {
  if (!(o.duration_s > 0.0 && o.duration_s <= 3600.0))
    faults.push_back("--duration: allowed is more than 0 to 3600 s");
  const bool whole = o.rate_Hz > 0.0 && std::llround(1e9 / o.rate_Hz) % kStep_ns == 0 && o.rate_Hz <= 2000.0;
  if (!whole)
    faults.push_back("--rate: allowed for a robot are 2000 Hz and its whole parts (1000, 500, 400 …)");
  if (!(o.noise_scale >= 0.0 && o.noise_scale <= 1000.0)) faults.push_back("--noise: allowed is 0 to 1000");
  if (!(o.amplitude >= -1.0 && o.amplitude <= 1.0))
    faults.push_back("--amplitude: allowed is -1 to 1, a duty");
  if (!o.drive.empty() && o.drive != "duty")
    faults.push_back(fmt::format("--drive {}: a robot is driven by duty", o.drive));
}

}  // namespace

std::optional<RobotBench> make_robot_bench(const BenchOptions& options, std::vector<std::string>& faults) {
  check_numbers(options, faults);
  StoredModel stored = load_robot_model(options.model, {data_folder("models")});
  for (const ModelProblem& p : stored.problems) faults.push_back(p.text());
  if (!stored.model) return std::nullopt;
  ModelBundle bundle = stored.bundle;
  add_effects(bundle, options.with, faults);
  const ModelReading reading = read_bundle(bundle);
  const double samples = options.duration_s * options.rate_Hz;
  if (!reading.model || !(samples > 0.0 && samples <= 1e7)) return std::nullopt;  // said above
  const RobotModel& robot = *reading.model->robot;
  const std::vector<Run> runs = runs_of(options, robot, faults);
  if (!faults.empty()) return std::nullopt;
  RobotBench bench;
  bench.files = {{"dataset.toml", dataset_text(options, robot, runs)},
                 {"model.toml", dataset_model_text(*stored.model)}};
  for (const Run& run : runs) {
    bench.files.push_back({run.name + ".csv", run_csv(options, robot, run, bench.diverged)});
    bench.rows += run.duty.size();
    ++bench.runs;
    if (!bench.diverged.empty()) break;
  }
  return bench;
}

}  // namespace omnihil
