// Lines of a sensor on a motor's shaft, as edges at their instants: what Hall sensors (hall_lines.h) and incremental encoders on
// pins (encoder_lines.h) have in common.
//
// Edges within a step of the plant come from the extrapolated shaft: a sensor shows its lines' levels now and says when the next
// edge is. A new step of the plant is looked at at once.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/board/board_spec.h"
#include "firmware_iface/mcu/board/world_state.h"
#include "firmware_iface/mcu/stm32/chip.h"

namespace omnihil::mcu {

class ShaftLines : public Peripheral {
 public:
  void reset() override {}
  std::uint32_t read(std::uint32_t, unsigned) override { return 0; }
  void write(std::uint32_t, unsigned, std::uint32_t) override {}
  void run_events() override {
    if (next_ <= system_.now()) go_on();
  }
  void clock_changed() override { plan(); }
  void world_changed() {  // a new step of the plant has begun, at now()
    const Cycles before = next_;
    go_on();
    if (next_ != before) system_.event_moved(&next_, before);
  }

 protected:
  ShaftLines(std::string name, const MotorEntry& entry, const std::vector<PinName>& pins, Chip& chip,
             System& system, std::function<const WorldState&()> world)
      : Peripheral(std::move(name)), entry_(entry), system_(system), world_(std::move(world)) {
    next_event_is(next_);
    for (const PinName& pin : pins) pins_.emplace_back(chip.port(pin.port), pin.pin);
  }
  // Shows the lines' levels at this instant; the time until the next edge, infinite: none comes.
  virtual double look(std::int64_t now_ns) = 0;

  double omega_rotor_rad_s() const {
    return world_().omega_rotor_rad_s[static_cast<std::size_t>(entry_.wheel)];
  }
  void drive(std::size_t line, bool level) const {
    if (line < pins_.size()) pins_[line].first->drive(pins_[line].second, level);
  }

  MotorEntry entry_;
  System& system_;
  std::function<const WorldState&()> world_;

 private:
  static constexpr double kStands_ns = 1e12;  // no edge within a quarter of an hour
  void go_on() {
    const std::int64_t now_ns = system_.to_ns(system_.now());
    const double wait_ns = look(now_ns);
    edge_ns_ = wait_ns < kStands_ns ? now_ns + static_cast<std::int64_t>(std::ceil(wait_ns)) + 1 : -1;
    plan();
  }
  void plan() { next_ = edge_ns_ < 0 ? kNever : std::max(system_.from_ns(edge_ns_), system_.now() + 1); }

  std::vector<std::pair<PinBank*, unsigned>> pins_;
  std::int64_t edge_ns_ = -1;  // the next edge; negative: none comes
  Cycles next_ = kNever;
};

}  // namespace omnihil::mcu
