// The three Hall lines of a motor, as edges at their instants on timer inputs and pins.
//
//   HallLines lines(entry, chip, machine, [&]() -> const WorldState& { return world; });
//
// Law: sensor x (0, 120, 240 electrical degrees) is high where 210 deg <= theta_elec - x < 390 deg, as the
// plant's own sensors are; codes 3 2 6 4 5 1 forward. Edges within a step come from the extrapolated shaft.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/board/world_state.h"
#include "firmware_iface/mcu/stm32/chip.h"
#include "firmware_iface/mcu/stm32/timer/timer.h"

namespace omnihil::mcu {

class HallLines final : public Peripheral {
 public:
  HallLines(const MotorEntry& entry, Chip& chip, System& system, std::function<const WorldState&()> world);
  void reset() override {}
  std::uint32_t read(std::uint32_t, unsigned) override { return 0; }
  void write(std::uint32_t, unsigned, std::uint32_t) override {}
  void run_events() override;
  void clock_changed() override {
    const std::int64_t now_ns = system_.to_ns(system_.now());
    plan(now_ns, electric_rad(now_ns));
  }
  void world_changed();  // a new step of the plant has begun, at now()
  static unsigned code(double theta_elec_rad);

 private:
  double electric_rad(std::int64_t at_ns) const;
  void show(unsigned code);
  void plan(std::int64_t now_ns, double theta_elec_rad);
  void look();

  MotorEntry entry_;
  System& system_;
  std::function<const WorldState&()> world_;
  Timer* timer_ = nullptr;
  std::vector<std::pair<PinBank*, unsigned>> pins_;
  unsigned shown_ = 0;
  Cycles next_ = kNever;
};

}  // namespace omnihil::mcu
