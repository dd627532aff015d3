// Rig "robot": two to six wheels on the floor, driven by what the bridges were asked for.
//
// Run forward from the measured start (rolling_robot.h). Open loop a robot's speed decays within a tenth of a
// second, so errors of speed do not accumulate; integrals of speed do, and are corrected by the measurement:
//   angles    laws of the angle take the measured rotor angles
//   heading   forces in the field's directions, and the rotation of displacements from body to field, take the
//             measured heading: the gyro's integral, corrected to the camera's over a second
//   pose      the model's path is compared after a slow correction towards the camera (0.5 s), so that an
//             error of speed dv appears as 0.5 s dv and does not grow
// Compared: "velocity_1" … (rotor, differences of counts on both sides), "motor_current_1" …,
// "gyro_z", "accel_x", "accel_y", "vision_x", "vision_y", "vision_theta" (where there is a frame).
// bus_voltage, where measured, is an input of the bridges, smoothed; and its drop is compared with that of
// the model's supply. Without it the model's supply is the input. Where the record has radio commands and no
// duties, the model's [controller] (radio_controller.h) closes the loop over the simulated speeds; its numbers
// are parameters as any others, and "wheel_speed_1" … are compared where telemetry has them.
#include "identify/predict/rolling_rig.h"
#include "identify/record/rig.h"

namespace omnihil {
namespace {

using enum SignalRole;

// A row per wheel that a robot may have (kMaxWheels).
#define EACH_WHEEL(name, ...)                                                                             \
  {name "_1", __VA_ARGS__}, {name "_2", __VA_ARGS__}, {name "_3", __VA_ARGS__}, {name "_4", __VA_ARGS__}, \
      {name "_5", __VA_ARGS__}, {                                                                         \
    name "_6", __VA_ARGS__                                                                                \
  }

constexpr SignalRow kSignals[] = {
    {"time", "s", "", kTime},
    EACH_WHEEL("duty", "1", "", kDrive, "duty"),
    {"command_vx", "m/s", "", kDrive, "command"},
    {"command_vy", "m/s", "", kDrive, "command"},
    {"command_w", "rad/s", "", kDrive, "command"},
    EACH_WHEEL("command_wheel", "rad/s", "", kDrive, "command_wheel"),
    {"dribbler", "rad/s", "", kMeasured},
    EACH_WHEEL("encoder", "counts", "", kCounts),
    EACH_WHEEL("wheel_speed", "rad/s", "", kMotion),
    EACH_WHEEL("motor_current", "A", "", kMeasured),
    {"bus_voltage", "V", "", kMeasured},
    {"gyro_z", "rad/s", "", kMotion},
    {"accel_x", "m/s^2", "", kMeasured},
    {"accel_y", "m/s^2", "", kMeasured},
    {"vision_x", "m", "", kMotion},
    {"vision_y", "m", "", kMotion},
    {"vision_theta", "rad", "", kMotion},
    {"body_vx", "m/s", "", kMotion, "", Imposed::kAlways},
    {"body_vy", "m/s", "", kMotion, "", Imposed::kAlways},
    {"body_w", "rad/s", "", kMotion, "", Imposed::kAlways},
    {"force_x", "N", "", kMeasured},
    {"force_y", "N", "", kMeasured},
};
#undef EACH_WHEEL

struct WholeRobot {
  static constexpr bool kRough = true;
  template <typename T>
  static RollingParams<T> params(const RollingParams<T>& robot) {
    return robot;
  }
  static Capabilities capabilities(const Dataset& dataset);
};

Capabilities WholeRobot::capabilities(const Dataset& dataset) {
  const bool camera = has_channel(dataset, "vision"), encoders = has_channel(dataset, "encoder");
  const bool imposed = has_channel(dataset, "body_");
  const bool body = imposed || camera || has_channel(dataset, "gyro") || has_channel(dataset, "accel");
  Capabilities out = rolling_capabilities(!imposed, kNeedsSeveralMotors);
  out.list.insert(
      out.list.end(),
      {{kNeedsCamera, camera, "needs a camera"},
       {kNeedsDribbler, has_channel(dataset, "dribbler"), "needs the dribbler's speed (channel dribbler)"},
       {kNeedsBodySpeed, body, "needs a body's speed: camera, gyro or accelerometer"},
       {kNeedsMeasuredCurrent, has_channel(dataset, "motor_current"), "needs measured currents"},
       {kNeedsShaftSensor | kNeedsEncoder | kNeedsAngle, encoders, "needs encoders"}});
  // Where radio commands drive, the model's controller has the delay.
  if (std::any_of(dataset.runs.begin(), dataset.runs.end(),
                  [](const Run& run) { return run.signal("duty_1") == nullptr; }))
    out.present_base.emplace_back("controller.latency_s");
  return out;
}

}  // namespace

const Rig& rig_robot() {
  static constexpr Rig kRig{
      .name = "robot",
      .what = "the whole robot on the floor",
      .of_robot = true,
      .whole_robot = true,
      .signals = kSignals,
      .drive_needed =
          "duty_1 to duty_4, or command_vx, command_vy and command_w, or "
          "command_wheel_1 to command_wheel_4 are needed (one per wheel)",
      .motion_needed =
          "encoder_1 to encoder_4, wheel_speed_1 to wheel_speed_4, gyro_z "
          "or vision_x, vision_y, vision_theta",
      .make_predictor = make_rig_predictor<RollingRig<WholeRobot>>,
  };
  return kRig;
}

}  // namespace omnihil
