// The two lines of a motor's incremental encoder, as edges at their instants on pins, for chips and programs that count
// them by interrupts or state machines.
//
//   EncoderLines lines(entry, chip, machine, [&]() -> const WorldState& { return world; });
//
// Law: upwards A leads: 00, 10, 11, 01 (count & 3); one count is one edge of one line. Edges within a step come from the
// extrapolated shaft. The lines never skip a count: where a new step of the plant finds the shaft further on, the edges
// between follow 1 us apart (a choice: no decoder that keeps up with 1 MHz loses one).
#pragma once
#include <array>
#include <functional>

#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/board/world_state.h"
#include "firmware_iface/mcu/stm32/chip.h"

namespace omnihil::mcu {

class EncoderLines final : public Peripheral {
 public:
  EncoderLines(const MotorEntry& entry, Chip& chip, System& system, std::function<const WorldState&()> world);
  void reset() override {}
  std::uint32_t read(std::uint32_t, unsigned) override { return 0; }
  void write(std::uint32_t, unsigned, std::uint32_t) override {}
  void run_events() override {
    if (next_ <= system_.now()) look();
  }
  void clock_changed() override { plan(); }
  void world_changed();  // a new step of the plant has begun, at now()

 private:
  std::int64_t count(std::int64_t at_ns) const;
  void show() const;
  void look();
  void plan();

  MotorEntry entry_;
  System& system_;
  std::function<const WorldState&()> world_;
  std::array<std::pair<PinBank*, unsigned>, 2> pins_;
  std::int64_t shown_ = 0;
  bool begun_ = false;
  Cycles next_ = kNever;
};

}  // namespace omnihil::mcu
