// The three Hall lines of a motor, as edges at their instants on timer inputs and pins.
//
//   HallLines lines(entry, chip, machine, [&]() -> const WorldState& { return world; });
//
// Law: sensor x (0, 120, 240 electrical degrees) is high where 210 deg <= theta_elec - x < 390 deg, as the
// plant's own sensors are; codes 3 2 6 4 5 1 forward.
#pragma once
#include "firmware_iface/mcu/board/shaft_lines.h"
#include "firmware_iface/mcu/stm32/timer/timer.h"

namespace omnihil::mcu {

class HallLines final : public ShaftLines {
 public:
  HallLines(const MotorEntry& entry, Chip& chip, System& system, std::function<const WorldState&()> world);
  static unsigned code(double theta_elec_rad);

 private:
  double electric_rad(std::int64_t at_ns) const;
  double look(std::int64_t now_ns) override;

  Timer* timer_ = nullptr;
  unsigned shown_ = 0;
};

}  // namespace omnihil::mcu
