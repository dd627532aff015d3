#include "identify/predict/predictor_robot.h"

#include "identify/predict/rolling_rig.h"

namespace omnihil {
namespace {

struct WholeRobot {
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
       {kNeedsShaftSensor | kNeedsEncoder | kNeedsAngle, encoders, "needs encoders"},
       {kNeedsPhase, encoders, "needs encoders: its phase is that of an angle"}});
  // Where radio commands drive, the model's controller has the delay.
  if (std::any_of(dataset.runs.begin(), dataset.runs.end(),
                  [](const Run& run) { return run.signal("duty_1") == nullptr; }))
    out.present_base.emplace_back("controller.latency_s");
  return out;
}

}  // namespace

std::unique_ptr<Predictor> make_robot_predictor(const Dataset& dataset, const Candidate& nominal,
                                                const PredictOptions& options) {
  return std::make_unique<RigPredictor<RollingRig<WholeRobot>>>(dataset, nominal, options);
}

}  // namespace omnihil
