#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/dataset/dataset_model.h"
#include "hil/loop/effect_overrides.h"
#include "hil/text/program_files.h"
#include "identify/predict/predictor.h"
#include "identify/record/signal_list.h"
#include "sim/law/random.h"
#include "sim/model/model_writer.h"
#include "sim/robot/wheel_load.h"
#include "tools/benches/virtual_bench.h"

namespace omnihil {
namespace {

constexpr double kShareOfSpeed = 0.4;  // of the robot's full speed, that the bench moves at: a choice
// 1-sigma of usual sensors: a shunt, a small load cell. Guesses, +-50 %.
constexpr double kCurrent_A = 0.03, kForce_N = 0.05;  // as above

// Duty whose stall current slips the tyre.
double slipping_duty(const RobotModel& m) {
  const double grip_N =
      m.tyre_longitudinal.extremum_value * m.mass_kg * kGravity_m_s2 / static_cast<double>(m.wheels);
  const double torque_Nm = grip_N * m.wheel_radius_m / m.gear_ratio;
  return torque_Nm / m.motor.torque_constant_Nm_per_A * m.motor.resistance_ohm / m.bus_voltage_V;
}

// Duty, and the body's velocity forward and to the left.
std::vector<BenchRow> driven(const BenchOptions& o, const RobotModel& m, Excitation kind, double scale,
                             std::uint64_t seed) {
  const double full_m_s = full_speed_m_s(m), push = scale * o.amplitude * slipping_duty(m);
  const double most_m_s = 0.5 * m.tyre_longitudinal.extremum_value * kGravity_m_s2 / o.rate_Hz;
  double vx = 0.0, vy = 0.0;
  return bench_rows(o, [&](double t) {
    const auto pattern = [&](std::uint64_t which) {
      return excitation_at(which == 0 ? kind : Excitation::kSteps, t,
                           {.duration_s = o.duration_s, .seed = mix_bits(3 * seed + which)});
    };
    const auto towards = [&](double now, double asked) {
      return now + std::clamp(asked * scale * kShareOfSpeed * full_m_s - now, -most_m_s, most_m_s);
    };
    vx = towards(vx, pattern(1)), vy = towards(vy, pattern(2));
    return std::vector<double>{std::clamp(vx / full_m_s + push * pattern(0), -1.0, 1.0), vx, vy};
  });
}

Run run_of(const BenchRun& planned) {
  Run run;
  for (const BenchRow& row : planned.input) {
    run.time_s.push_back(row.time_s);
    run.signals["duty"].push_back(row.values[0]);
    run.signals["body_vx"].push_back(row.values[1]);
    run.signals["body_vy"].push_back(row.values[2]);
  }
  // what will be measured
  for (const char* name : {"motor_current", "encoder", "force_x", "force_y"})
    run.signals[name].resize(run.time_s.size());
  return run;
}

Dataset blank(const BenchOptions& o, const RobotModel& m, const std::vector<BenchRun>& runs) {
  Dataset d;
  d.rig = Rig::kWheel;
  const auto channel = [&](const char* name, double sigma = 0.0) -> Channel& {
    d.channels.push_back(
        {.signal = name, .column = name, .unit = std::string(find_signal(d.rig, name)->unit)});
    d.channels.back().sigma = sigma * o.noise_scale;
    return d.channels.back();
  };
  channel("duty");
  channel("body_vx").imposed = true;
  channel("body_vy").imposed = true;
  channel("motor_current", kCurrent_A);
  channel("encoder").counts_per_rev = m.encoder.counts_per_turn;
  channel("force_x", kForce_N);
  channel("force_y", kForce_N);
  for (const BenchRun& run : runs) d.runs.push_back(run_of(run));
  return d;
}

std::vector<BenchColumn> columns_of(const Dataset& d) {
  std::vector<BenchColumn> out;
  for (const Channel& c : d.channels) {
    out.push_back({.signal = c.signal, .column = c.column, .sigma = c.sigma});
    if (c.counts_per_rev > 0.0)
      out.back().more = fmt::format(", counts_per_rev = {:g}, shaft = \"rotor\"", c.counts_per_rev);
  }
  return out;
}

std::string run_text(const std::vector<BenchColumn>& columns, const Run& run) {
  std::string text = bench_header(columns);
  for (std::size_t k = 0; k < run.time_s.size(); ++k) {
    std::vector<double> values;
    for (const BenchColumn& c : columns) values.push_back((*run.signal(c.signal))[k]);
    text += bench_line(columns, run.time_s[k], values);
  }
  return text;
}

}  // namespace

std::optional<VirtualBench> make_wheel_bench(const BenchOptions& o, std::vector<std::string>& faults) {
  const std::optional<BenchRobot> opened = open_robot(o, faults);
  if (!opened) return std::nullopt;
  const auto& [stored, reading] = *opened;
  const RobotModel& robot = *stored.model->robot;
  const auto runs = bench_runs(
      o, faults,
      [&](Excitation e, double scale, std::uint64_t seed) { return driven(o, robot, e, scale, seed); },
      [&](const std::string& path) {
        faults.push_back(fmt::format("--excite {}: of a wheel excitations by name are allowed", path));
        return std::vector<BenchRow>();
      });
  if (!faults.empty()) return std::nullopt;
  const Dataset asked = blank(o, robot, runs);
  const auto measured =
      make_predictor(asked, candidate_of(*stored.model), {})->simulated(candidate_of(*reading.model), o.seed);
  const std::vector<BenchColumn> columns = columns_of(asked);
  VirtualBench bench;
  bench.files = {{"dataset.toml", bench_dataset("simulated: a wheel of " + o.model, "wheel", columns, runs)},
                 {"model.toml", dataset_model_text(*stored.model)}};
  for (const BenchRun& planned : runs) {
    const Run& run = measured->run(static_cast<int>(bench.runs++));
    bench.files.push_back({planned.name + ".csv", run_text(columns, run)});
    bench.rows += run.time_s.size();
    for (const auto& [name, values] : run.signals) {
      const auto bad = std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
      if (bad == values.end() || !bench.diverged.empty()) continue;
      bench.diverged = fmt::format("run {}: {} is not finite at {:.6f} s", planned.name, name,
                                   run.time_s[static_cast<std::size_t>(bad - values.begin())]);
    }
  }
  return bench;
}

}  // namespace omnihil
