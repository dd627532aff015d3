// Camera frames that are older than their stamp: exposure, transfer and processing.
#include "sim/law/effect_entry.h"

namespace omnihil {
namespace {

struct VisionDelay {
  enum Param { kDelay };
  static constexpr EffectParam kParams[] = {
      {.name = "delay_s",
       .unit = "s",
       .typical = 0.015,  // about one frame at 60 to 75 Hz (estimate)
       .lower = 0,
       .upper = 0.5,
       .prior_scale = 0.02,
       .what = "how much older than its stamp a vision frame is",
       .how = "a robot that swings to and fro: its encoders against its position in the frames",
       .trait = ParamTrait::kTime},
  };
  static constexpr EffectInfo kInfo{
      .id = "vision_delay",
      .title = "Vision delay",
      .equation = "p(t) -> p(t - d) for what cameras see of the robot",
      .source = "Ljung, System Identification, 2nd ed. 1999 (time delay of the output)",
      .cannot = "differ between cameras, drop or swap frames; the drive's own sensors are not affected",
      .place = Place::kTiming,
      .twins = {"sampling_delay"},
      .reveals =
          "robot driven to and fro: position in the frames late against that from its encoders, by the "
          "same time at every speed",
      .visible = "a hundredth of a frame's period with twenty seconds of motion; 75 Hz",
      .min_visible =
          [](const SensorSet& s) { return 0.2 / 75.0 / (s.duration_s > 1.0 ? s.duration_s : 1.0); },
      .claims = kOdd,
      .rigs = kOnRobot,
      .demands = kNeedsCamera,
      .params = kParams,
  };

  template <typename T>
  static void apply(const T* p, T*, TimingPort<T>& port) {
    // p(t - d)
    if (port.what == Stamped::kVision) port.age_s += p[kDelay];
  }
};

}  // namespace

OMNIHIL_EFFECT(vision_delay, VisionDelay)

}  // namespace omnihil
