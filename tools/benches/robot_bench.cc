#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hil/dataset/dataset_model.h"
#include "hil/loop/effect_overrides.h"
#include "hil/text/program_files.h"
#include "sim/law/random.h"
#include "sim/model/full_speed.h"
#include "sim/model/model_writer.h"
#include "sim/robot/plant.h"
#include "tools/benches/virtual_bench.h"

namespace omnihil {
namespace {

constexpr double kCamera_Hz = 60.0;         // rate of the league's vision
constexpr std::int64_t kStep_ns = 500'000;  // of the mechanics

// 1-sigma of usual sensors (guesses, +-50 %).
constexpr double kBus_V = 0.02, kCurrent_A = 0.03, kGyro_rad_s = 0.01, kAccel_m_s2 = 0.1, kVision_m = 0.001,
                 kVision_rad = 0.005;

using Duties = PerWheel<double>;

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
  return 0.5 * m.tyre_longitudinal.extremum_value * 9.81 / full_speed_m_s(m);
}

std::vector<double> listed(const RobotModel& m, const Duties& d) {
  return {d.begin(), d.begin() + static_cast<std::ptrdiff_t>(m.wheels)};
}

std::vector<BenchRow> excited(Excitation kind, const RobotModel& m, const BenchOptions& o, double scale,
                              std::uint64_t seed) {
  const double most = gentle_slew_per_s(m) / o.rate_Hz;
  Duties last{};
  return bench_rows(o, [&](double t) {
    const auto one = [&](std::uint64_t which) {
      return excitation_at(kind, t, {.duration_s = o.duration_s, .seed = mix_bits(3 * seed + which)});
    };
    // patterns without a seed (ramp, chirp) would be one motion: each third has its own direction
    const bool seeded = kind == Excitation::kSteps || kind == Excitation::kPrbs;
    const double third = 3.0 * t / o.duration_s;
    const auto part = [&](double from) { return third >= from && third < from + 1.0 ? 1.0 : 0.0; };
    const double x = seeded ? 0.6 * one(0) : one(0) * part(0), y = seeded ? 0.6 * one(1) : one(0) * part(1);
    const double w = seeded ? 0.4 * one(2) : one(0) * part(2);
    const Duties asked = duties_of(m, x, y, w);
    for (std::size_t i = 0; i < m.wheels; ++i)
      last[i] += std::clamp(asked[i] * o.amplitude * scale - last[i], -most, most);
    return listed(m, last);
  });
}

// Rows of a CSV file, held to the rate of the run.
std::vector<BenchRow> read_file(const std::string& path, const RobotModel& m, const BenchOptions& o,
                                std::vector<std::string>& faults) {
  const std::size_t widths[] = {1, m.wheels};
  const std::string words =
      fmt::format("one or {} duties", m.wheels == 4 ? "four" : std::to_string(m.wheels));
  std::vector<BenchRow> out;
  for (BenchRow& row : read_bench_rows(path, widths, words, faults)) {
    if (row.values.size() == 1) row.values = listed(m, duties_of(m, row.values[0], 0, 0));
    const auto upto = static_cast<std::size_t>(std::max(0.0, row.time_s) * o.rate_Hz + 0.5);
    while (out.size() < upto && !out.empty()) out.push_back(out.back());
    out.push_back(std::move(row));
  }
  return out;
}

// In the order of measured().
std::vector<BenchColumn> columns_of(const BenchOptions& o, const RobotModel& m) {
  std::vector<BenchColumn> out;
  const auto add = [&](const std::string& signal, const std::string& column, const char* format,
                       double sigma = 0.0, const std::string& more = "") {
    out.push_back({signal, column, format, sigma * o.noise_scale, more, signal});
  };
  const std::string counts =
      fmt::format(", counts_per_rev = {}, shaft = \"rotor\"{}", m.encoder.counts_per_turn,
                  m.encoder.direction < 0 ? ", scale = -1" : "");
  for (std::size_t i = 1; i <= m.wheels; ++i)
    add(fmt::format("duty_{}", i), fmt::format("duty_{}", i), "{:.9g}");
  add("bus_voltage", "bus_V", "{:.4f}", kBus_V);
  for (std::size_t i = 1; i <= m.wheels; ++i) {
    add(fmt::format("motor_current_{}", i), fmt::format("current_{}", i), "{:.5f}", kCurrent_A);
    out.back().stream = fmt::format("motor_current_{}", i - 1);
    add(fmt::format("encoder_{}", i), fmt::format("ticks_{}", i), "{:.0f}", 0.0, counts);
  }
  add("gyro_z", "gyro_z", "{:.5f}", kGyro_rad_s);
  add("accel_x", "accel_x", "{:.5f}", kAccel_m_s2);
  add("accel_y", "accel_y", "{:.5f}", kAccel_m_s2);
  add("vision_x", "vision_x", "{:.6f}", kVision_m);
  add("vision_y", "vision_y", "{:.6f}", kVision_m);
  add("vision_theta", "vision_theta", "{:.6f}", kVision_rad);
  return out;
}

// What the sensors would show without noise; a camera's frame where there is one.
std::vector<double> measured(Plant& plant, const RobotModel& m, const BenchRow& asked, bool frame) {
  const PlantSensors all = plant.sample_all(0);
  const RobotSensors& s = all.board;
  std::vector<double> out = asked.values;
  out.push_back(s.bus_voltage_V);
  for (std::size_t i = 0; i < m.wheels; ++i) {
    out.push_back(all.motor_current_A[i]);
    out.push_back(static_cast<double>(all.encoder_counts[i]));
  }
  out.insert(out.end(), {s.gyro_z_rad_s, s.accel_x_m_s2, s.accel_y_m_s2});
  const VisionPose p = frame ? plant.vision(0) : VisionPose{};
  for (const double v : {p.x_m, p.y_m, p.yaw_rad}) out.push_back(frame ? v : std::nan(""));
  return out;
}

// Drives the robot through one run; the CSV so far when the plant diverged.
std::string run_csv(const BenchOptions& o, const RobotModel& m, const std::vector<BenchColumn>& columns,
                    const BenchRun& run, std::uint64_t seed, std::string& diverged) {
  PlantOptions options;
  options.physics = Physics::kPlanar;
  options.mechanical_step_ns = kStep_ns;
  options.seed = seed;
  Plant plant(std::vector<RobotModel>{m}, options);
  const std::int64_t period_ns = std::llround(1e9 / o.rate_Hz);
  std::string text = bench_header(columns);
  std::int64_t last_frame = -1;
  for (std::size_t k = 0; k < run.input.size(); ++k) {
    const double time_s = static_cast<double>(plant.now_ns()) * 1e-9;
    // the first row at or after each camera frame carries it
    const auto frame = static_cast<std::int64_t>(std::floor(time_s * kCamera_Hz + 1e-9));
    text += bench_line(columns, time_s, measured(plant, m, run.input[k], frame != last_frame), seed, k);
    last_frame = frame;
    Duties duty{};
    std::copy(run.input[k].values.begin(), run.input[k].values.end(), duty.begin());
    plant.write_duties(0, duty);
    if (k + 1 < run.input.size()) plant.advance(period_ns);
    if (plant.fault()) {
      diverged = fmt::format("run {}: {} {} is not finite at {:.6f} s", run.name, plant.fault()->signal,
                             plant.fault()->index + 1, time_s);
      break;
    }
  }
  return text;
}

}  // namespace

std::optional<VirtualBench> make_robot_bench(const BenchOptions& options, std::vector<std::string>& faults) {
  const std::optional<BenchRobot> opened = open_robot(options, faults);
  if (!opened) return std::nullopt;
  const auto& [stored, reading] = *opened;
  const RobotModel& robot = *reading.model->robot;
  const auto runs = bench_runs(
      options, faults,
      [&](Excitation e, double scale, std::uint64_t seed) { return excited(e, robot, options, scale, seed); },
      [&](const std::string& path) { return read_file(path, robot, options, faults); });
  if (!faults.empty()) return std::nullopt;
  const std::vector<BenchColumn> columns = columns_of(options, robot);
  VirtualBench bench;
  bench.files = {{"dataset.toml", bench_dataset("simulated: " + options.model, "robot", columns, runs)},
                 {"model.toml", dataset_model_text(*stored.model)}};
  for (const BenchRun& run : runs) {
    const std::uint64_t seed = mix_bits(options.seed + bench.runs);
    bench.files.push_back({run.name + ".csv", run_csv(options, robot, columns, run, seed, bench.diverged)});
    bench.rows += run.input.size();
    ++bench.runs;
    if (!bench.diverged.empty()) break;
  }
  return bench;
}

}  // namespace omnihil
