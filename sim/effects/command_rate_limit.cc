// Limit of the command's rate: firmware that ramps the duty instead of letting it jump.
#include "sim/effects/loop_period.h"
#include "sim/law/effect_entry.h"
#include "sim/law/rate_limit.h"

namespace omnihil {
namespace {

struct CommandRateLimit {
  enum Param { kInverseRate, kLoopPeriod };
  enum State { kRamped, kStarted };
  static constexpr EffectParam kParams[] = {
      {.name = "inverse_rate_s",
       .unit = "s",
       .typical = 0.1,  // ramps of speed controllers: 0.05 to 0.5 s from none to full (data sheets)
       .lower = 0,
       .upper = 10,
       .prior_scale = 0.2,
       .what = "time that a change by full duty takes; 0: it jumps",
       .how = "large steps of the duty: slope of current and speed, the same for every size of step"},
      kLoopPeriodRow,
  };
  static constexpr EffectState kStates[] = {
      {.name = "duty_ratio", .unit = "1"},
      {.name = "started", .unit = "1"},  // 0 until the first call, which starts from what was asked before
  };
  static constexpr EffectInfo kInfo{
      .id = "command_rate_limit",
      .title = "Limit of the duty's rate",
      .equation =
          "|dx/dt| <= 1 / q, q = inverse_rate_s, D' = x + min(|D - x|, P / 2 q) sgn(D - x), P the loop's "
          "period",
      .source =
          "Biagiotti, Melchiorri, Trajectory Planning for Automatic Machines and Robots, 2008 "
          "(constant-velocity profile)",
      .cannot =
          "other rates up than down, S-curves; the ripple of a loop's steps about their mean; acts on duties "
          "only",
      .place = Place::kCommand,
      .twins = {"command_low_pass", "actuator_delay", "current_limit"},
      .reveals =
          "large and small steps of the duty: the lag grows with the step's size; slow ramps and small "
          "steps are not affected",
      .visible = "a limit that a step by full duty outlasts by a sample",
      .min_visible = [](const SensorSet& s) { return 1.0 / s.rate_Hz; },
      .claims = kOdd,
      .numerics = kFine | kHidesDelays,
      .demands = kNeedsDuty | kNeedsSimulation,
      .excludes = {"controller.latency_s", BaseExclusion::kWherePresent},
      .params = kParams,
      .states = kStates,
      .plot = {.excitation = "steps", .x = "time", .y = "velocity", .from_s = 0.35, .to_s = 0.8},
  };

  template <typename T>
  static void apply(const T* p, T* x, CommandPort<T>& port) {
    if (port.kind != CommandKind::kDuty) return;
    if (value_of(x[kStarted]) == 0.0) {
      x[kStarted] = T(1);
      x[kRamped] = port.asked_before();
    }
    // A loop that turns every P holds D(t + P) for P, in the mean D(t + P / 2): P / 2 q further, at most at the target
    const T way = port.setpoint - x[kRamped];
    const T ahead = value_of(p[kInverseRate]) > 0.0 ? T(0.5 * p[kLoopPeriod] / p[kInverseRate]) : T(0);
    T seen = way * sign_of(way) > ahead ? T(x[kRamped] + sign_of(way) * ahead) : port.setpoint;
    walk_towards(x[kRamped], port.setpoint, port.dt_s, p[kInverseRate]);
    // |dD'/dt| <= 1 / q, its mean over the sub-step
    const Walked<T> ramp = walk_towards(seen, port.setpoint, port.dt_s, p[kInverseRate]);
    port.setpoint = ramp.mean - ramp.lost;
  }
};

}  // namespace

OMNIHIL_EFFECT(command_rate_limit, CommandRateLimit)

}  // namespace omnihil
