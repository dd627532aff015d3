// How much floor a planned run takes: the way of a robot that does at once what it is asked.
//
//   FloorNeed need = floor_need(plan, run, robot);                // rolling_params(model.parameters)
//   need.x_from_m, need.x_to_m;      // from where it stands, x where it looks
//   need.stopping_m;                 // beyond that, wherever it is stopped
//
// A real robot lags and slips: it reaches no further than these speeds take it, but may drift on a long run. Duties are the
// speeds that they end at without load: duty V / k. Integrated at 1 ms, exactly along each arc.
#pragma once
#include "hil/acquire/acquire_plan.h"
#include "sim/rolling/rolling_params.h"

namespace omnihil {

struct FloorNeed {
  double x_from_m = 0.0, x_to_m = 0.0, y_from_m = 0.0, y_to_m = 0.0;
  double farthest_m = 0.0;  // from the start
  double fastest_m_s = 0.0;
  double stopping_m = 0.0;  // from the fastest, at kBrake_m_s2
  double x_end_m = 0.0, y_end_m = 0.0;
};

inline constexpr double kBrake_m_s2 = 2.0;  // less than the weakest tyre of the models gives: a choice

FloorNeed floor_need(const AcquirePlan& plan, const PlanRun& run, const RollingParams<double>& robot);

// What a step asks of the body: m/s, m/s, rad/s.
std::array<double, 3> asked_of_body(PlanDrive drive, const std::array<double, kWheels>& value,
                                    const RollingParams<double>& robot);

}  // namespace omnihil
