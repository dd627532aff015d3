// Limit of the target's speed: a servo that walks to a new target instead of jumping there.
#include "sim/law/effect_entry.h"
#include "sim/law/rate_limit.h"

namespace omnihil {
namespace {

struct TargetSpeedLimit {
  enum Param { kInverseRate };
  enum State { kWalking, kStarted };
  static constexpr EffectParam kParams[] = {
      {.name = "inverse_rate_s_per_rad",
       .unit = "s/rad",
       .typical = 0.15,  // 4.8 to 8 rad/s (serial bus servos, measured)
       .lower = 0,
       .upper = 100,
       .prior_scale = 0.2,
       .what = "one over the fastest the target moves; 0: it jumps",
       .how = "large steps of the target: slope of the position, the same for every size of step"},
  };
  static constexpr EffectState kStates[] = {
      {.name = "target_rad", .unit = "rad"},
      {.name = "started", .unit = "1"},  // 0 until the first call, which starts from where the axis stands
  };
  static constexpr EffectInfo kInfo{
      .id = "target_speed_limit",
      .title = "Speed limit of the target",
      .equation = "|d target'/dt| <= 1 / q, q = inverse_rate_s_per_rad; target' starts at the position",
      .source =
          "Biagiotti, Melchiorri, Trajectory Planning for Automatic Machines and Robots, 2008 "
          "(constant-velocity profile)",
      .cannot =
          "limits of acceleration (trapezoids, S-curves), a profile that restarts from the measured "
          "position; acts on position targets only",
      .place = Place::kCommand,
      .twins = {"actuator_delay", "current_limit"},
      .reveals =
          "large and small steps of the target: the error grows with the step's size, at the same "
          "slope of the position; small steps are not affected",
      .visible = "a limit that the largest step outlasts by three samples",
      .min_visible =
          [](const SensorSet& s) {
            // A step of 1 rad that takes three samples longer.
            return 3.0 / s.rate_Hz;
          },
      .claims = kOdd | kFlatAtNeutral,
      .numerics = kHidesDelays,
      .demands = kNeedsPositionServo,
      .params = kParams,
      .states = kStates,
      .plot = {.excitation = "servo", .x = "time", .y = "position", .from_s = 0.0, .to_s = 2.0},
  };

  template <typename T>
  static void apply(const T* p, T* x, CommandPort<T>& port) {
    if (port.kind != CommandKind::kPositionTarget) return;
    if (value_of(x[kStarted]) == 0.0) {
      x[kStarted] = T(1);
      x[kWalking] = port.position_rad;
    }
    // |d target'/dt| <= 1 / q, its mean over the sub-step
    port.setpoint = walk_towards(x[kWalking], port.setpoint, port.dt_s, p[kInverseRate]).mean;
  }
};

}  // namespace

OMNIHIL_EFFECT(target_speed_limit, TargetSpeedLimit)

}  // namespace omnihil
