#include "identify/predict/predictor_wheel.h"

#include <numbers>

#include "identify/predict/rolling_rig.h"

namespace omnihil {
namespace {

struct OneWheel {
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
                                     {kNeedsShaftSensor | kNeedsEncoder | kNeedsAngle | kNeedsPhase,
                                      has_channel(dataset, "encoder"), "needs an encoder"}});
    return out;
  }
};

}  // namespace

std::unique_ptr<Predictor> make_wheel_predictor(const Dataset& dataset, const Candidate& robot,
                                                const PredictOptions& options) {
  return std::make_unique<RigPredictor<RollingRig<OneWheel>>>(dataset, robot, options);
}

}  // namespace omnihil
