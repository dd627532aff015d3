// What an effect needs of the rig that it is to act on, and what a rig offers: a refusal is the difference.
//
//   const Capabilities rig{.rig = kOnAxis, .list = {{kNeedsWinding, true, ""}, {kNeedsDuty, false, "needs duty"}}};
//   std::string why = refusal(*find_effect("duty_limit")->info, rig);    // "needs duty"; "": it can act
//
// A place has demands of its own (demands_of): an effect says only what goes beyond them.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace omnihil {

struct EffectInfo;  // sim/law/effect.h

enum DemandBit : std::uint32_t {
  kNeedsNothing = 0,
  kNeedsFloor = 1u << 0,   // a robot on its wheels
  kNeedsCamera = 1u << 1,  // that sees the robot's pose
  kNeedsSeveralMotors = 1u << 2,
  kNeedsSupply = 1u << 3,         // a bus that feeds the drive
  kNeedsWinding = 1u << 4,        // voltage or current is known: not a drive by torque
  kNeedsPositionServo = 1u << 5,  // a position target
  kNeedsDuty = 1u << 6,           // bridges driven by duty
  kNeedsVoltage = 1u << 7,        // a winding at a voltage: not a loop that makes the current what it is told
  kNeedsTwoInertias = 1u << 8,    // one on either side of the shaft
  kNeedsSimulation = 1u << 9,     // the motion is the model's, not taken as measured (the forward method)
  kNeedsReportedSpeed = 1u << 10,    // that the drive's electronics make
  kNeedsDribbler = 1u << 11,         // its speed
  kNeedsBodySpeed = 1u << 12,        // camera, gyro or accelerometer
  kNeedsShaftSensor = 1u << 13,      // angle or speed of the shaft
  kNeedsEncoder = 1u << 14,          // that counts
  kNeedsAngle = 1u << 15,            // of the shaft: an encoder, or a position that the drive reports
  kNeedsFreeBody = 1u << 16,         // that forces move: not one that a bench moves
  kNeedsMeasuredCurrent = 1u << 17,  // of the winding
};
inline constexpr int kDemands = 18;

// A base parameter beside which an effect has no place: it would do the same.
struct BaseExclusion {
  enum When : std::uint8_t {
    kWhereFree,     // its model file gives it a tolerance
    kWherePresent,  // its value is not 0
  };
  std::string_view path = "";  // ""; none
  When when = kWhereFree;
};

// One thing that a rig may offer, and how it says that it does not.
struct Capability {
  std::uint32_t bits = 0;
  bool there = false;
  std::string_view refusal;  // "needs a camera"
};

struct Capabilities {
  std::uint32_t rig = 0;               // RigsBit
  std::string_view other_rig = "";     // of effects that are for other rigs: "acts on a robot on the floor"
  std::vector<Capability> list;        // the first that is demanded and not there is the refusal
  std::vector<std::string> free_base;  // paths, for BaseExclusion
  std::vector<std::string> present_base;
  // Of a speed loop that is described in place of the firmware: what happens within a period, it does not know. 0: none.
  double loop_period_s = 0.0;
};

// The effect's own and its place's.
std::uint32_t demands_of(const EffectInfo& info);
// "" where it can act. What a rig does not list, it does not have.
std::string refusal(const EffectInfo& info, const Capabilities& rig);
// "a drive by duty": of one bit, in a rig's words or not.
std::string_view demand_name(DemandBit bit);

}  // namespace omnihil
