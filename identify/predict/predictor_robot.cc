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
  const bool camera = has_channel(dataset, "vision");
  const bool imposed = has_channel(dataset, "body_");
  const bool body = imposed || camera || has_channel(dataset, "gyro") || has_channel(dataset, "accel");
  // Several drives by duty from one bus, simulated as a whole. Base parameters exclude no effect: what a tolerance
  // of an inductance trades with is for the fit to say.
  constexpr std::uint32_t kAlways = kNeedsFloor | kNeedsSeveralMotors | kNeedsSupply | kNeedsWinding |
                                    kNeedsDuty | kNeedsVoltage | kNeedsSimulation;
  // Where radio commands drive, the model's controller has the delay.
  std::vector<std::string> present;
  if (std::any_of(dataset.runs.begin(), dataset.runs.end(),
                  [](const Run& run) { return run.signal("duty_1") == nullptr; }))
    present.emplace_back("controller.latency_s");
  return {.rig = kOnRobot,
          .other_rig = "acts on a single axis",
          .list = {{kAlways, true, ""},
                   {kNeedsFreeBody, !imposed, "the bench moves the body, whatever forces do"},
                   {kNeedsTwoInertias, false,
                    "needs a freedom between rotor and wheel, which a robot's model lacks"},
                   {kNeedsPositionServo, false, "needs a position servo"},
                   {kNeedsReportedSpeed, false, "needs a speed that the drive's electronics estimate"},
                   {kNeedsCamera, camera, "needs a camera"},
                   {kNeedsDribbler, has_channel(dataset, "dribbler"),
                    "needs the dribbler's speed (channel dribbler)"},
                   {kNeedsBodySpeed, body, "needs a body's speed: camera, gyro or accelerometer"},
                   {kNeedsShaftSensor | kNeedsEncoder | kNeedsAngle, has_channel(dataset, "encoder"),
                    "needs encoders"},
                   {kNeedsPhase, has_channel(dataset, "encoder"),
                    "needs encoders: its phase is that of an angle"}},
          .free_base = {},
          .present_base = std::move(present)};
}

}  // namespace

std::unique_ptr<Predictor> make_robot_predictor(const Dataset& dataset, const Candidate& nominal,
                                                const PredictOptions& options) {
  return std::make_unique<RigPredictor<RollingRig<WholeRobot>>>(dataset, nominal, options);
}

}  // namespace omnihil
