// The simplified omni wheel (two tyre curves) against the full one, on the same voltages.
//
//   for (const WheelManoeuvre& m : wheel_manoeuvres(model)) {
//     WheelRun full = run_full_wheel(model, {}, m, 1e-4), planar = run_simplified(model, m, Physics::kPlanar, 5e-4);
//     WheelDifference d = difference_of(full, planar);            // d.rms_m, d.end_m, d.way_m
//   }
//
// Motors are eq. (7) without inductance and dry friction in all of them, so that only wheels differ. Places every 10 ms.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sim/full_wheel/full_wheel_robot.h"
#include "sim/robot/plant.h"

namespace omnihil {

struct WheelManoeuvre {
  std::string name;
  double duration_s = 0.0;
  std::function<std::array<double, kWheels>(double time_s)> volt;
};
// Forward, sideways, diagonal, a turn on the spot, a curve with everything in it, a start at full voltage.
std::vector<WheelManoeuvre> wheel_manoeuvres(const RobotModel& model);

struct WheelRun {
  std::vector<PlanarState> at;  // every 10 ms
};
WheelRun run_full_wheel(const RobotModel& model, const RollerParams& rollers, const WheelManoeuvre& manoeuvre,
                        double step_s);
// kPlanar or kSimbody; RK4.
WheelRun run_simplified(const RobotModel& model, const WheelManoeuvre& manoeuvre, Physics physics,
                        double step_s);

struct WheelDifference {
  double way_m = 0, turned_rad = 0;  // of the full one
  double rms_m = 0, end_m = 0, end_rad = 0;
};
WheelDifference difference_of(const WheelRun& full, const WheelRun& simplified);

}  // namespace omnihil
