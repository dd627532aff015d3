// The two lines of a motor's incremental encoder, as edges at their instants on pins, for chips and programs that count
// them by interrupts or state machines.
//
//   EncoderLines lines(entry, chip, machine, [&]() -> const WorldState& { return world; });
//
// Law: upwards A leads: 00, 10, 11, 01 (count & 3); one count is one edge of one line. The lines never skip a count: where a
// new step of the plant finds the shaft further on, the edges between follow 1 us apart (a choice: no decoder that keeps up
// with 1 MHz loses one).
#pragma once
#include "firmware_iface/mcu/board/shaft_lines.h"

namespace omnihil::mcu {

class EncoderLines final : public ShaftLines {
 public:
  EncoderLines(const MotorEntry& entry, Chip& chip, System& system, std::function<const WorldState&()> world);

 private:
  std::int64_t count(std::int64_t at_ns) const;
  double look(std::int64_t now_ns) override;

  std::int64_t shown_ = 0;
  bool begun_ = false;
};

}  // namespace omnihil::mcu
