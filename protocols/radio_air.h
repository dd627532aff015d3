// What the air does to a packet: the dongles ask it for every one that passes between them and a robot.
//
//   struct DeadAir : RadioAir {
//     bool lost(int, AirWay) override { return true; }
//   };
//
// Without one nothing is lost, nothing comes late or twice, and no bit is flipped.
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace omnihil {

enum class AirWay : std::uint8_t { kToRobot, kToHost };

// How often a packet arrives, and how much later than by the dongle's own times.
struct AirFate {
  int copies = 1;  // 0: lost
  std::array<std::int64_t, 2> late_ns{};
};

// What became of a packet after the air had it.
enum class AirVerdict : std::uint8_t {
  kRefused,  // with wrong bits, and the format's own checks saw it
  kSlipped,  // with wrong bits, and they did not
  kCrowded   // more were under way than a receiver can hold
};

class RadioAir {
 public:
  virtual ~RadioAir() = default;
  // Of this one packet. Asked once for each, in the order of sending.
  virtual bool lost(int robot_id, AirWay way) = 0;
  // The same, with all that the air does to its time. `at_ns`: when it would arrive.
  virtual AirFate fate(int robot_id, AirWay way, std::int64_t /*at_ns*/) {
    return {.copies = lost(robot_id, way) ? 0 : 1};
  }
  // Of each copy that arrives: flips bits in it; true: it flipped some, and judged() follows.
  virtual bool flip(std::span<std::uint8_t> /*packet*/) { return false; }
  virtual void judged(AirWay, AirVerdict) {}
};

}  // namespace omnihil
