#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hil/dataset/dataset_model.h"
#include "hil/loop/effect_overrides.h"
#include "hil/text/program_files.h"
#include "sim/drive/sensor_chain.h"
#include "sim/law/random.h"
#include "sim/model/model_writer.h"
#include "sim/robot/plant.h"
#include "tools/benches/virtual_bench.h"

namespace omnihil {
namespace {

constexpr double kCamera_Hz = 60.0;         // rate of the league's vision
constexpr std::int64_t kStep_ns = 500'000;  // of the mechanics

// 1-sigma of usual sensors (guesses, +-50 %), in the order of the columns.
constexpr double kBus_V = 0.02, kCurrent_A = 0.03, kGyro_rad_s = 0.01, kAccel_m_s2 = 0.1, kVision_m = 0.001,
                 kVision_rad = 0.005;

using Duties = PerWheel<double>;

using Run = BenchRun<std::vector<Duties>>;

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

// Rows of a CSV file, held to the rate of the run.
std::vector<Duties> read_file(const std::string& path, const RobotModel& m, const BenchOptions& o,
                              std::vector<std::string>& faults) {
  const std::size_t widths[] = {1, m.wheels};
  const std::string words =
      fmt::format("one or {} duties", m.wheels == 4 ? "four" : std::to_string(m.wheels));
  std::vector<Duties> out;
  for (const BenchRow& row : read_bench_rows(path, widths, words, faults)) {
    Duties now{};
    if (row.values.size() == 1)
      now = duties_of(m, row.values[0], 0, 0);
    else
      std::copy(row.values.begin(), row.values.end(), now.begin());
    const auto upto = static_cast<std::size_t>(std::max(0.0, row.time_s) * o.rate_Hz + 0.5);
    while (out.size() < upto && !out.empty()) out.push_back(out.back());
    out.push_back(now);
  }
  return out;
}

std::string dataset_text(const BenchOptions& o, const RobotModel& m, const std::vector<Run>& runs) {
  const auto channel = [&](const std::string& signal, const std::string& column, double sigma) {
    return channel_line(signal, column, sigma * o.noise_scale);
  };
  std::string text = dataset_head("simulated: " + o.model, "robot") + channel("time", "time_s", 0);
  for (std::size_t i = 1; i <= m.wheels; ++i)
    text += channel(fmt::format("duty_{}", i), fmt::format("duty_{}", i), 0);
  text += channel("bus_voltage", "bus_V", kBus_V);
  const std::string counts =
      fmt::format(", counts_per_rev = {}, shaft = \"rotor\"{}", m.encoder.counts_per_turn,
                  m.encoder.direction < 0 ? ", scale = -1" : "");
  for (std::size_t i = 1; i <= m.wheels; ++i) {
    text += channel(fmt::format("motor_current_{}", i), fmt::format("current_{}", i), kCurrent_A);
    text += channel_line(fmt::format("encoder_{}", i), fmt::format("ticks_{}", i), 0, counts);
  }
  text += channel("gyro_z", "gyro_z", kGyro_rad_s);
  text += channel("accel_x", "accel_x", kAccel_m_s2) + channel("accel_y", "accel_y", kAccel_m_s2);
  text += channel("vision_x", "vision_x", kVision_m) + channel("vision_y", "vision_y", kVision_m);
  text += channel("vision_theta", "vision_theta", kVision_rad);
  for (const Run& run : runs) text += run_lines(run.name, run.use, run.excitation);
  return text;
}

// Drives the robot through one run; the CSV so far when the plant diverged.
std::string run_csv(const BenchOptions& o, const RobotModel& m, const Run& run, std::uint64_t seed,
                    std::string& diverged) {
  PlantOptions options;
  options.physics = Physics::kPlanar;
  options.mechanical_step_ns = kStep_ns;
  options.seed = seed;
  Plant plant(std::vector<RobotModel>{m}, options);
  const std::int64_t period_ns = std::llround(1e9 / o.rate_Hz);
  std::string text = "time_s";
  for (std::size_t i = 1; i <= m.wheels; ++i) text += fmt::format(",duty_{}", i);
  text += ",bus_V";
  for (std::size_t i = 1; i <= m.wheels; ++i) text += fmt::format(",current_{0},ticks_{0}", i);
  text += ",gyro_z,accel_x,accel_y,vision_x,vision_y,vision_theta\n";
  std::int64_t last_frame = -1;
  for (std::size_t k = 0; k < run.input.size(); ++k) {
    const PlantSensors all = plant.sample_all(0);
    const RobotSensors& s = all.board;
    const auto measured = [&](double value, double sigma, std::string_view stream) {
      return noisy(value, sigma * o.noise_scale, seed, stream, k);
    };
    const double time_s = static_cast<double>(plant.now_ns()) * 1e-9;
    text += fmt::format("{:.6f}", time_s);
    for (std::size_t i = 0; i < m.wheels; ++i) text += fmt::format(",{:.9g}", run.input[k][i]);
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
    plant.write_duties(0, run.input[k]);
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
  const auto runs = bench_runs<std::vector<Duties>>(
      options, faults,
      [&](Excitation e, double scale, std::uint64_t seed) { return excited(e, robot, options, scale, seed); },
      [&](const std::string& path) { return read_file(path, robot, options, faults); },
      [](const std::vector<Duties>& d, std::size_t from, std::size_t to) {
        return std::vector<Duties>(d.begin() + static_cast<std::ptrdiff_t>(from),
                                   d.begin() + static_cast<std::ptrdiff_t>(to));
      },
      [](const std::vector<Duties>& d) { return d.size(); });
  if (!faults.empty()) return std::nullopt;
  VirtualBench bench;
  bench.files = {{"dataset.toml", dataset_text(options, robot, runs)},
                 {"model.toml", dataset_model_text(*stored.model)}};
  for (const Run& run : runs) {
    const std::uint64_t seed = mix_bits(options.seed + bench.runs);
    bench.files.push_back({run.name + ".csv", run_csv(options, robot, run, seed, bench.diverged)});
    bench.rows += run.input.size();
    ++bench.runs;
    if (!bench.diverged.empty()) break;
  }
  return bench;
}

}  // namespace omnihil
