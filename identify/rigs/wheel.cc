// Rig "wheel": one omni wheel of a robot on a floor, its body moved by the bench: a belt, a drum, a carriage on rails.
//
// The model is the robot's own file. Its wheel stands on the floor with its share of the robot's weight,
//     N = m g / n,
// drives along x (forward) and lets its rollers turn along y (left). Given: duty (or enable), the body's velocity body_vx,
// body_vy in m/s over the floor, bus voltage. Compared: encoder, current, bus, and what a load cell sees of the floor's
// force on the wheel: force_x, force_y in N. What it finds of motor and tyre stands in the robot's file, where the
// robot's own runs are compared with it.
// Cannot: a body that turns, a load that changes, a force measured through a mount that swings.
//
// A virtual bench of it moves the body forward and sideways by patterns of their own, no faster than half of the tyre's grip
// would; the duty is the one that rolls with it, and a push by the excitation on top: the amplitude of the duty that slips
// the tyre at standstill.
#include <algorithm>
#include <numbers>

#include "identify/predict/rolling_rig.h"
#include "identify/record/rig.h"
#include "sim/bench/excitation.h"
#include "sim/law/random.h"
#include "sim/model/full_speed.h"
#include "sim/robot/wheel_load.h"

namespace omnihil {
namespace {

using enum SignalRole;

constexpr SignalRow kSignals[] = {
    {"time", "s", "", kTime},
    {"duty", "1", "", kDrive, "duty"},
    {"enable", "1", "", kFlag},
    {"body_vx", "m/s", "", kMotion, "", Imposed::kAlways},
    {"body_vy", "m/s", "", kMotion, "", Imposed::kAlways},
    {"bus_voltage", "V", "", kMeasured},
    {"motor_current", "A", "", kMeasured},
    {"encoder", "counts", "", kCounts},
    {"wheel_speed", "rad/s", "", kMotion},
    {"force_x", "N", "", kMeasured},
    {"force_y", "N", "", kMeasured},
};
constexpr GivenSignal kGiven[] = {
    {"body_vx", "the velocity that the bench gave the wheel's body, 0 where it stood"}};

struct OneWheel {
  static constexpr bool kRough = false;
  template <typename T>
  static RollingParams<T> params(const RollingParams<T>& robot) {
    RollingParams<T> wheel = robot;
    wheel.wheels = 1;
    wheel.wheel_angle_rad = {-0.5 * std::numbers::pi};  // its drive direction (-sin a, cos a) is x
    wheel.mass_kg = robot.mass_kg * (1.0 / static_cast<double>(robot.wheels));
    return wheel;
  }

  static Capabilities capabilities(const Dataset& dataset) {
    Capabilities out = rolling_capabilities(false, kNeedsBodySpeed);
    out.list.insert(out.list.end(), {{kNeedsSeveralMotors, false, "needs more than one motor"},
                                     {kNeedsCamera, false, "needs a camera"},
                                     {kNeedsDribbler, false, "needs the dribbler"},
                                     {kNeedsMeasuredCurrent, has_channel(dataset, "motor_current"),
                                      "needs a measured current"},
                                     {kNeedsShaftSensor | kNeedsEncoder | kNeedsAngle,
                                      has_channel(dataset, "encoder"), "needs an encoder"}});
    return out;
  }
};

// ---- Its virtual bench

constexpr double kShareOfSpeed = 0.4;  // of the robot's full speed, that the bench moves at: a choice
constexpr double kShareOfGrip = 0.5;   // of what the tyre could accelerate the body by: a choice
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
std::function<std::vector<double>(double)> driven(const Candidate& model, const BenchDrive& asked) {
  const RobotModel& m = *model.file.robot;
  const double full_m_s = full_speed_m_s(m), push = asked.scale * asked.amplitude * slipping_duty(m);
  const double most_m_s = kShareOfGrip * m.tyre_longitudinal.extremum_value * kGravity_m_s2 / asked.rate_Hz;
  return [=, vx = 0.0, vy = 0.0](double t) mutable {
    const auto pattern = [&](std::uint64_t which) {
      return excitation_at(which == 0 ? asked.excitation : Excitation::kSteps, t,
                           {.duration_s = asked.duration_s, .seed = mix_bits(3 * asked.seed + which)});
    };
    const auto towards = [&](double now, double wanted) {
      return now + std::clamp(wanted * asked.scale * kShareOfSpeed * full_m_s - now, -most_m_s, most_m_s);
    };
    vx = towards(vx, pattern(1)), vy = towards(vy, pattern(2));
    return std::vector<double>{std::clamp(vx / full_m_s + push * pattern(0), -1.0, 1.0), vx, vy};
  };
}

std::vector<Channel> channels(const Candidate& model) {
  const auto channel = [](const char* name, double sigma = 0.0, double counts_per_rev = 0.0) {
    return Channel{
        .signal = name, .column = name, .unit = {}, .sigma = sigma, .counts_per_rev = counts_per_rev};
  };
  return {channel("duty"),
          channel("body_vx"),
          channel("body_vy"),
          channel("motor_current", kCurrent_A),
          channel("encoder", 0.0, model.file.robot->encoder.counts_per_turn),
          channel("force_x", kForce_N),
          channel("force_y", kForce_N)};
}

constexpr RigBench kBench{.channels = channels, .given = driven};

}  // namespace

const Rig& rig_wheel() {
  static constexpr Rig kRig{
      .name = "wheel",
      .what = "one of its wheels on the floor, its body moved by the bench",
      .of_robot = true,
      .signals = kSignals,
      .drive_needed = "duty is needed",
      .motion_needed = "encoder or wheel_speed is needed",
      .given = kGiven,
      .no_plan = "of a wheel on a bench no drive is planned: the bench gives half of it",
      .make_predictor = make_rig_predictor<RollingRig<OneWheel>>,
      .bench = &kBench,
  };
  return kRig;
}

}  // namespace omnihil
