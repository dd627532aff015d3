// `omnihil field wheel`: the simplified omni wheel against one with all its rollers, on the same voltages, and the cost.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <memory>
#include <numbers>
#include <string>

#include "hil/field_play/path_test.h"
#include "hil/loop/model_store.h"
#include "hil/text/dataset_files.h"
#include "hil/text/program_files.h"
#include "sim/full_wheel/wheel_comparison.h"
#include "tools/exit_codes.h"
#include "tools/field_verbs.h"
#include "tools/guarded.h"

namespace omnihil {
namespace {

struct WheelArguments {
  std::string robot = "omni_default", picture;
  int rollers = 18;
  double bearing_rad_s = RollerParams{}.bearing_rad_s;
};

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::vector<PathPoint> path_of(const WheelRun& run) {
  std::vector<PathPoint> path;
  for (const PlanarState& s : run.at)
    path.push_back({0.01 * static_cast<double>(path.size()), s.x_m, s.y_m, s.yaw_rad});
  return path;
}

int run_wheel(const WheelArguments& a) {
  const StoredModel stored = load_robot_model(a.robot, {data_folder("models")});
  for (const ModelProblem& problem : stored.problems) fmt::print(stderr, "{}\n", problem.text());
  if (!stored.model || !stored.model->robot) return kExitBadInput;
  const RobotModel& model = *stored.model->robot;
  RollerParams rollers;
  rollers.count = a.rollers;
  rollers.bearing_rad_s = a.bearing_rad_s;
  constexpr double kDegree = 180.0 / std::numbers::pi;
  double full_s = 0.0, planar_s = 0.0, simbody_s = 0.0, simulated_s = 0.0;
  fmt::print("{:<11} {:>7} {:>7} | planar: {:>8} {:>8} {:>7} {:>8} | simbody: {:>8}\n", "manoeuvre", "way, m",
             "deg", "rms, mm", "end, mm", "of way", "end, deg", "end, mm");
  for (const WheelManoeuvre& m : wheel_manoeuvres(model)) {
    double at = cpu_s();
    const WheelRun full = run_full_wheel(model, rollers, m, 1e-4);
    full_s += cpu_s() - at;
    at = cpu_s();
    const WheelRun planar = run_simplified(model, m, Physics::kPlanar, 5e-4);
    planar_s += cpu_s() - at;
    at = cpu_s();
    const WheelRun simbody = run_simplified(model, m, Physics::kSimbody, 5e-4);
    simbody_s += cpu_s() - at;
    simulated_s += m.duration_s;
    const WheelDifference p = difference_of(full, planar), s = difference_of(full, simbody);
    fmt::print(
        "{:<11} {:>7.2f} {:>7.1f} |         {:>8.2f} {:>8.2f} {:>5.2f} % {:>8.2f} |          {:>8.2f}\n",
        m.name, p.way_m, kDegree * p.turned_rad, 1e3 * p.rms_m, 1e3 * p.end_m,
        100.0 * p.end_m / std::max(0.01, p.way_m), kDegree * p.end_rad, 1e3 * s.end_m);
    if (!a.picture.empty() && m.name == "curve") {
      PathTest paths;
      paths.real = path_of(full);
      paths.model = path_of(planar);
      paths.way_m = p.way_m, paths.rms_m = p.rms_m, paths.end_m = p.end_m;
      replace_file(a.picture, path_picture(paths, model.name, fmt::format("{} rollers", 4 * a.rollers),
                                           "two tyre curves"));
    }
  }
  fmt::print(
      "cost of a simulated second: {} rollers {:.1f} ms (step 0.1 ms), simplified in Simbody {:.2f} ms, "
      "planar "
      "{:.3f} ms (RK4, 0.5 ms): {:.0f} and {:.0f} times less\n",
      4 * a.rollers, 1e3 * full_s / simulated_s, 1e3 * simbody_s / simulated_s, 1e3 * planar_s / simulated_s,
      full_s / std::max(1e-9, simbody_s), full_s / std::max(1e-9, planar_s));
  return kExitOk;
}

}  // namespace

void add_field_wheel(Verb& field, VerbResult& result) {
  auto a = std::make_shared<WheelArguments>();
  Verb verb = field.add_subcommand("wheel", "the simplified omni wheel against one with all its rollers");
  verb.add_option("--robot", a->robot, "robot model: a name or a .toml file").capture_default_str();
  verb.add_option("--rollers", a->rollers, "of each wheel").range(6, 60).capture_default_str();
  verb.add_option("--bearing", a->bearing_rad_s, "roller speed, rad/s, from which its bearing brakes fully")
      .range(0.01, 1e4)
      .capture_default_str();
  verb.add_option("--picture", a->picture, "both paths of the manoeuvre \"curve\" to this file, as SVG");
  verb.callback([a, &result] { result.exit_code = guarded("field wheel", [&] { return run_wheel(*a); }); });
}

}  // namespace omnihil
