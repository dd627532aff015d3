#include "sim/law/demands.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "sim/law/effect.h"

namespace omnihil {
namespace {

std::uint32_t demands_of(Place place) {
  switch (place) {
    case Place::kSupply:
      return kNeedsSupply;
    case Place::kBridge:
    case Place::kWinding:
      return kNeedsWinding;
    case Place::kShaft:
      return kNeedsTwoInertias;
    case Place::kContact:
      return kNeedsFloor;
    case Place::kBody:
      return kNeedsFloor | kNeedsFreeBody;
    case Place::kSensor:
      return kNeedsSimulation | kNeedsShaftSensor;
    case Place::kTiming:
      return kNeedsSimulation;
    case Place::kCommand:
    case Place::kTorque:
      return kNeedsNothing;
  }
  return kNeedsNothing;
}

bool among(const std::vector<std::string>& paths, std::string_view path) {
  return std::find(paths.begin(), paths.end(), path) != paths.end();
}

}  // namespace

std::uint32_t demands_of(const EffectInfo& info) { return info.demands | demands_of(info.place); }

std::string_view demand_name(DemandBit bit) {
  static constexpr std::string_view kNames[kDemands] = {"a robot on the floor",
                                                        "a camera",
                                                        "more than one motor",
                                                        "a supply",
                                                        "a drive by duty, voltage or current",
                                                        "a position target",
                                                        "a drive by duty",
                                                        "a winding",
                                                        "an inertia on either side of the shaft",
                                                        "a motion that is simulated",
                                                        "a speed that the drive reports",
                                                        "the dribbler's speed",
                                                        "a body's speed: camera, gyro or accelerometer",
                                                        "a sensor of the shaft",
                                                        "an encoder",
                                                        "an angle of the shaft",
                                                        "a body that moves freely",
                                                        "a current that is measured"};
  return bit == kNeedsNothing ? "" : kNames[std::countr_zero(static_cast<std::uint32_t>(bit))];
}

std::string refusal(const EffectInfo& info, const Capabilities& rig) {
  if ((info.rigs & rig.rig) == 0) return std::string(rig.other_rig);
  std::uint32_t missing = demands_of(info);
  for (const Capability& c : rig.list) {
    if ((missing & c.bits) == 0) continue;
    if (!c.there) return std::string(c.refusal);
    missing &= ~c.bits;
  }
  if (missing != 0)
    return fmt::format("needs {}", demand_name(static_cast<DemandBit>(missing & (~missing + 1))));
  const auto& [path, when] = info.excludes;
  if (path.empty()) return "";
  if (when == BaseExclusion::kWhereFree && among(rig.free_base, path))
    return fmt::format("the base model's {} is free", path);
  if (when == BaseExclusion::kWherePresent && among(rig.present_base, path))
    return fmt::format("the base model has {}", path);
  return "";
}

}  // namespace omnihil
