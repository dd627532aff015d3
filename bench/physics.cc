// What the physics costs and how exact it is.
//
//   bench_physics            prints the table; exit 0 when every target is met, 1 when one is missed
//   bench_physics --quick    a tenth of the measuring time
//
// Cost: simulated time over CPU time of this thread (not wall time), the best and the median of several
// repetitions. Error: six robots, five seconds of open-loop driving with a new duty each millisecond, against
// a run converged in step: the largest distance of the centre and the largest difference of a wheel's speed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bench/cpu_time.h"
#include "sim/model/model_file.h"
#include "sim/robot/plant.h"

namespace omnihil {
namespace {

struct Setting {
  const char* name;
  Physics physics;
  Integrator integrator;
  std::int64_t step_ns;
};

constexpr Integrator kEuler = Integrator::kSemiImplicitEuler;
constexpr Integrator kRk4 = Integrator::kRungeKutta4;
constexpr Setting kSettings[] = {
    {"planar, Euler, 1 ms", Physics::kPlanar, kEuler, 1'000'000},
    {"planar, Euler, 0.5 ms", Physics::kPlanar, kEuler, 500'000},
    {"planar, Euler, 0.25 ms", Physics::kPlanar, kEuler, 250'000},
    {"planar, Euler, 0.1 ms", Physics::kPlanar, kEuler, 100'000},
    {"planar, RK4, 1 ms", Physics::kPlanar, kRk4, 1'000'000},
    {"planar, RK4, 0.5 ms", Physics::kPlanar, kRk4, 500'000},
    {"planar, RK4, 0.25 ms", Physics::kPlanar, kRk4, 250'000},
    {"planar, RK4, 0.1 ms", Physics::kPlanar, kRk4, 100'000},
    {"Simbody, Euler, 1 ms", Physics::kSimbody, kEuler, 1'000'000},
    {"Simbody, RK4, 1 ms", Physics::kSimbody, kRk4, 1'000'000},
    {"Simbody, RK4, 0.5 ms", Physics::kSimbody, kRk4, 500'000},
    {"Simbody, RK4, 0.25 ms", Physics::kSimbody, kRk4, 250'000},
    {"Simbody free, Euler, 0.5 ms", Physics::kSimbodyFree, kEuler, 500'000},
    {"Simbody free, RK4, 0.5 ms", Physics::kSimbodyFree, kRk4, 500'000},
    {"Simbody free, RK4, 0.25 ms", Physics::kSimbodyFree, kRk4, 250'000},
};

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

RobotModel default_robot() {
  const std::string folder = OMNIHIL_SOURCE_DIR "/models/robots/";
  const ModelReading reading =
      read_model(text_of(folder + "omni_default.toml"), "omni_default.toml", [&](const std::string& motor) {
        return MotorFileText{motor, text_of(folder + motor), ""};
      });
  for (const ModelProblem& problem : reading.problems) std::fprintf(stderr, "%s\n", problem.text().c_str());
  if (!reading.model || !reading.model->robot) std::exit(2);
  return *reading.model->robot;
}

Plant make_plant(const RobotModel& model, int robots, const Setting& setting) {
  PlantOptions o;
  o.physics = setting.physics;
  o.integrator = setting.integrator;
  o.mechanical_step_ns = setting.step_ns;
  o.electrical_step_ns = std::min<std::int64_t>(50'000, setting.step_ns);
  return Plant(std::vector<RobotModel>(static_cast<std::size_t>(robots), model), o);
}

// 8 V and 3 V sines on each wheel, each wheel and robot at its own phase.
void drive(Plant& plant, double volt) {
  const double t_s = static_cast<double>(plant.now_ns()) * 1e-9;
  for (int n = 0; n < plant.robot_count(); ++n) {
    RobotDrive d{};
    for (int i = 0; i < kWheels; ++i) {
      d.mode[i] = OMNIHIL_DRIVE_DUTY;
      d.duty_ratio[i] =
          (8.0 * std::sin(2.1 * t_s + 1.3 * i + 0.37 * n) + 3.0 * std::sin(11.0 * t_s + 0.7 * i)) / volt;
    }
    plant.write(n, d);
  }
  plant.advance(1'000'000);
}

std::vector<RobotTruth> truth_after(const RobotModel& model, const Setting& setting, int robots,
                                    double time_s) {
  Plant plant = make_plant(model, robots, setting);
  for (int ms = 0; ms < std::lround(time_s * 1e3); ++ms) drive(plant, model.bus_voltage_V);
  std::vector<RobotTruth> out;
  for (int n = 0; n < robots; ++n) out.push_back(plant.truth(n));
  return out;
}

struct Error {
  double position_mm = 0.0;
  double wheel_rad_s = 0.0;
};

Error error_of(const std::vector<RobotTruth>& a, const std::vector<RobotTruth>& converged) {
  Error e;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const double distance_m = std::hypot(a[n].x_m - converged[n].x_m, a[n].y_m - converged[n].y_m);
    e.position_mm = std::max(e.position_mm, 1e3 * distance_m);
    for (std::size_t i = 0; i < kWheels; ++i) {
      e.wheel_rad_s =
          std::max(e.wheel_rad_s, std::abs(a[n].omega_wheel_rad_s[i] - converged[n].omega_wheel_rad_s[i]));
    }
  }
  return e;
}

// Simulated seconds per CPU second.
struct Speed {
  double best = 0.0, median = 0.0;
};

Speed speed_of(const RobotModel& model, const Setting& setting, int robots, double repetition_s) {
  Plant plant = make_plant(model, robots, setting);
  int milliseconds = 20;
  double cost_s = 0.0;
  const auto run = [&](int count) {
    const double start_s = thread_cpu_s();
    for (int ms = 0; ms < count; ++ms) {
      drive(plant, model.bus_voltage_V);
      for (int n = 0; n < robots; ++n) (void)plant.sample_sensors(n);
    }
    return thread_cpu_s() - start_s;
  };
  while ((cost_s = run(milliseconds)) < 0.01) milliseconds *= 2;
  milliseconds = std::max(1, static_cast<int>(milliseconds * repetition_s / cost_s));
  std::vector<double> speeds;
  for (int n = 0; n < 7; ++n) speeds.push_back(milliseconds * 1e-3 / run(milliseconds));
  std::sort(speeds.begin(), speeds.end());
  return {speeds.back(), speeds[speeds.size() / 2]};
}

struct Row {
  Setting setting;
  Speed one, twelve;
  Error error;
};

const Row& find(const std::vector<Row>& rows, const char* name) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const Row& r) { return std::strcmp(r.setting.name, name) == 0; });
}

bool target(const char* what, double value, double at_least) {
  std::printf("  %-62s %8.1f x  at least %5.0f  %s\n", what, value, at_least,
              value >= at_least ? "met" : "MISSED");
  return value >= at_least;
}

int run(bool quick) {
  const RobotModel model = default_robot();
  const double repetition_s = quick ? 0.02 : 0.2;
  const auto planar_converged = truth_after(model, {"", Physics::kPlanar, kRk4, 5'000}, 6, 5.0);
  const auto free_converged =
      truth_after(model, {"", Physics::kSimbodyFree, kRk4, quick ? 50'000 : 25'000}, 6, 5.0);
  std::printf("%s; simulated over CPU time, best and median; error after 5 s against a converged run\n",
              model.name.c_str());
  std::printf("%-28s %19s %21s %12s %12s\n", "physics, integrator, step", "1 robot", "12 robots",
              "position mm", "wheel rad/s");
  std::vector<Row> rows;
  for (const Setting& s : kSettings) {
    const bool free = s.physics == Physics::kSimbodyFree;
    const Row r{s, speed_of(model, s, 1, repetition_s), speed_of(model, s, 12, repetition_s),
                error_of(truth_after(model, s, 6, 5.0), free ? free_converged : planar_converged)};
    std::printf("%-28s %8.1f x %8.1f %10.1f x %8.1f %12.3f %12.4f\n", s.name, r.one.best, r.one.median,
                r.twelve.best, r.twelve.median, r.error.position_mm, r.error.wheel_rad_s);
    std::fflush(stdout);
    rows.push_back(r);
  }
  std::printf("\nratios (cost, best of 12 robots)\n");
  const double simbody = find(rows, "Simbody, Euler, 1 ms").twelve.best;
  std::printf("  closed form over Simbody, Euler at 1 ms %37.0f\n",
              find(rows, "planar, Euler, 1 ms").twelve.best / simbody);
  std::printf("  planar joint at 1 ms over free body at 0.5 ms, Euler %24.1f\n",
              simbody / find(rows, "Simbody free, Euler, 0.5 ms").twelve.best);
  std::printf("  one System: 12 robots cost as much as this many alone %23.1f\n",
              find(rows, "Simbody, Euler, 1 ms").one.best / simbody);
  std::printf("\ntargets\n");
  const PlantOptions defaults;
  bool good = true;
  for (const Row& r : rows) {
    if (r.setting.physics == Physics::kPlanar && r.setting.integrator == defaults.integrator &&
        r.setting.step_ns == defaults.mechanical_step_ns) {
      good =
          target((std::string("1 robot, default step: ") + r.setting.name).c_str(), r.one.best, 200) && good;
    }
  }
  good = target("12 robots, Simbody planar joint, one System, Euler, 1 ms", simbody, 12) && good;
  good = target("12 robots, Simbody free bodies, Euler, 2 kHz",
                find(rows, "Simbody free, Euler, 0.5 ms").twelve.best, 4) &&
         good;
  return good ? 0 : 1;
}

// One row alone, for a count of its instructions: the setting's index and the robots, "5x12"; the milliseconds are printed.
int count(const std::string& row_name, long ms) {
  clock_counts_looks = true;
  std::size_t robots_at = 0;
  const std::size_t setting = std::stoul(row_name, &robots_at);
  if (setting >= std::size(kSettings) || row_name[robots_at] != 'x') return 2;
  const double repetition_s =
      static_cast<double>(ms) / 20.0;  // of speed_of()'s first run, a second by this clock
  speed_of(default_robot(), kSettings[setting], std::stoi(row_name.substr(robots_at + 1)), repetition_s);
  std::printf("%ld\n", 7 * ms);
  return 0;
}

}  // namespace
}  // namespace omnihil

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--count") == 0) return omnihil::count(argv[2], std::atol(argv[3]));
  return omnihil::run(argc > 1 && std::strcmp(argv[1], "--quick") == 0);
}
