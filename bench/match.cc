// What a match costs: robots of two teams with motors, ball, contacts and walls, against the number of robots.
//
//   bench_match            prints the table; exit 0 when every target is met, 1 when one is missed
//   bench_match --quick    a tenth of the measuring time
//
// Cost: simulated time over CPU time of this thread (not wall time), best of several repetitions. Robots drive at random
// about a division B field with the ball among them, so that they meet each other and the boards.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "bench/cpu_time.h"
#include "sim/field/world.h"
#include "sim/model/model_file.h"

namespace omnihil {
namespace {

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
  if (!reading.model || !reading.model->robot) std::exit(2);
  return *reading.model->robot;
}

struct Setting {
  const char* name;
  Physics physics;
  Integrator integrator;
  std::int64_t step_ns;
};
constexpr Setting kAccurate{"planar, RK4, 0.25 ms", Physics::kPlanar, Integrator::kRungeKutta4, 250'000};
constexpr Setting kUsual{"planar, RK4, 0.5 ms", Physics::kPlanar, Integrator::kRungeKutta4, 500'000};
constexpr Setting kSimbody{"Simbody, Euler, 1 ms", Physics::kSimbody, Integrator::kSemiImplicitEuler,
                           1'000'000};

World match(const RobotModel& model, int robots, const Setting& setting, bool field) {
  PlantOptions o;
  o.physics = setting.physics;
  o.integrator = setting.integrator;
  o.mechanical_step_ns = setting.step_ns;
  o.electrical_step_ns = 50'000;
  WorldOptions w;
  w.contacts = w.handling = field;
  if (field) w.field = &kFieldDivisionB;
  World world(std::vector<RobotModel>(static_cast<std::size_t>(robots), model), o, w);
  for (int n = 0; n < robots; ++n) world.put_robot(n, -2.0 + 0.8 * (n % 6), -1.5 + 0.8 * (n / 6), 0.7 * n);
  if (field) world.put_ball(0.1, 0.1, 0.0, {3.0, 1.0, 0.0});
  return world;
}

struct Cost {
  double times_real = 0.0;
  std::uint64_t touches = 0;
};

Cost cost_of(const RobotModel& model, int robots, const Setting& setting, bool field, double repetition_s) {
  World world = match(model, robots, setting, field);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> duty(-0.4, 0.4);
  Cost cost;
  const auto run = [&](int count) {
    const double start_s = thread_cpu_s();
    for (int ms = 0; ms < count; ++ms) {
      for (int n = 0; n < robots; ++n) {
        if (random() % 300 == 0) {
          RobotDrive d{};
          for (int i = 0; i < kWheels; ++i) {
            d.mode[i] = OMNIHIL_DRIVE_DUTY;
            d.duty_ratio[i] = duty(random);
          }
          d.dribbler_ratio = 0.5;
          d.charge = 1;
          world.write(n, d);
        }
        (void)world.sample_sensors(n);
      }
      world.advance(1'000'000);
      cost.touches += world.events().size();
    }
    return thread_cpu_s() - start_s;
  };
  int milliseconds = 50;
  double spent_s = 0.0;
  while ((spent_s = run(milliseconds)) < 0.01) milliseconds *= 2;
  milliseconds = std::max(1, static_cast<int>(milliseconds * repetition_s / spent_s));
  for (int n = 0; n < 5; ++n)
    cost.times_real = std::max(cost.times_real, milliseconds * 1e-3 / run(milliseconds));
  return cost;
}

bool target(const char* what, double found, double least) {
  std::printf("  %-62s %7.1f x  at least %5.0f  %s\n", what, found, least, found >= least ? "met" : "missed");
  return found >= least;
}

}  // namespace
}  // namespace omnihil

int main(int argc, char** argv) {
  using namespace omnihil;
  const double repetition_s = argc > 1 && std::strcmp(argv[1], "--quick") == 0 ? 0.03 : 0.3;
  const RobotModel model = default_robot();
  std::printf("%s; motors in steps of 50 us (20 kHz), ball, contacts, boards; simulated over CPU time\n",
              model.name.c_str());
  std::printf("%-24s", "physics, step");
  for (const int robots : {2, 6, 12, 22}) std::printf("%9d robots", robots);
  std::printf("   of 12: contacts cost\n");
  double accurate = 0.0, usual = 0.0, simbody = 0.0;
  for (const Setting& setting : {kAccurate, kUsual, kSimbody}) {
    std::printf("%-24s", setting.name);
    double twelve = 0.0;
    for (const int robots : {2, 6, 12, 22}) {
      const Cost cost = cost_of(model, robots, setting, true, repetition_s);
      std::printf("%14.1f x", cost.times_real);
      if (robots == 12) twelve = cost.times_real;
    }
    const double alone = cost_of(model, 12, setting, false, repetition_s).times_real;
    std::printf("   %18.1f %%\n", 100.0 * (1.0 - twelve / alone));
    if (std::strcmp(setting.name, kAccurate.name) == 0) accurate = twelve;
    if (std::strcmp(setting.name, kUsual.name) == 0) usual = twelve;
    if (std::strcmp(setting.name, kSimbody.name) == 0) simbody = twelve;
  }
  std::printf("\n12 robots in real time on the usual setting: %.1f %% of a core\n\ntargets\n", 100.0 / usual);
  bool met = target("12 robots, accurate (planar, RK4, 0.25 ms)", accurate, 30.0);
  met = target("12 robots, usual setting (20 % of a core is 5 x)", usual, 5.0) && met;
  met = target("12 robots, Simbody", simbody, 4.0) && met;
  return met ? 0 : 1;
}
