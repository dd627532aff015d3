// What the air does to a packet: the dongles ask it for every one that passes between them and a robot.
//
//   struct DeadAir : RadioAir {
//     bool lost(int, AirWay) override { return true; }
//   };
//
// Without one nothing is lost.
#pragma once
#include <cstdint>

namespace omnihil {

enum class AirWay : std::uint8_t { kToRobot, kToHost };

class RadioAir {
 public:
  virtual ~RadioAir() = default;
  // Of this one packet. Asked once for each, in the order of sending.
  virtual bool lost(int robot_id, AirWay way) = 0;
};

}  // namespace omnihil
