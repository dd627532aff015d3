#include "firmware_iface/mcu/board/hall_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace omnihil::mcu {
namespace {
constexpr double kPi = 3.141592653589793, kTwoPi = 2 * kPi, kSector = kPi / 3;
}

HallLines::HallLines(const MotorEntry& entry, Chip& chip, System& system,
                     std::function<const WorldState&()> world)
    : Peripheral("Hall lines of wheel " + std::to_string(entry.wheel)),
      entry_(entry),
      system_(system),
      world_(std::move(world)),
      timer_(chip.find<Timer>(entry.hall_timer)) {
  next_event_is(next_);
  for (const PinName& pin : entry.hall_pins) pins_.emplace_back(chip.port(pin.port), pin.pin);
}

double HallLines::electric_rad(std::int64_t at_ns) const {
  return world_().rotor_rad(entry_.wheel, at_ns) * entry_.hall_pole_pairs;
}

void HallLines::look() {
  const std::int64_t now_ns = system_.to_ns(system_.now());
  const double theta_elec_rad = electric_rad(now_ns);
  show(code(theta_elec_rad));
  plan(now_ns, theta_elec_rad);
}

unsigned HallLines::code(double theta_elec_rad) {
  unsigned code = 0;
  for (unsigned x = 0; x < 3; ++x) {
    const double turns = (theta_elec_rad - x * kTwoPi / 3) / kTwoPi - 210.0 / 360.0;
    if (turns - std::floor(turns) < 0.5) code |= 1u << x;
  }
  return code;
}

void HallLines::show(unsigned code) {
  if (entry_.hall_inverted) code ^= 7u;
  const unsigned changed = code ^ shown_;
  shown_ = code;
  for (unsigned x = 0; x < 3; ++x) {
    if ((changed >> x & 1u) == 0) continue;
    const bool level = (code >> x & 1u) != 0;
    if (x < pins_.size()) pins_[x].first->drive(pins_[x].second, level);
    if (timer_ != nullptr) timer_->set_input(x, level);
  }
}

void HallLines::world_changed() {
  const Cycles before = next_;
  look();
  if (next_ != before) system_.event_moved(&next_, before);
}

// The next edge is half a sector away from a multiple of one: at 30, 90, 150 … electrical degrees.
void HallLines::plan(std::int64_t now_ns, double theta_elec_rad) {
  next_ = kNever;
  const WorldState& world = world_();
  const double omega =
      world.omega_rotor_rad_s[static_cast<std::size_t>(entry_.wheel)] * entry_.hall_pole_pairs;
  if (std::abs(omega) < 1e-6) return;
  const double at = theta_elec_rad / kSector - 0.5;
  constexpr double kPast = 1e-9;  // of a sector: an edge that has just been passed is not the next
  const double edge = omega > 0 ? std::floor(at + kPast) + 1.0 : std::ceil(at - kPast) - 1.0;
  const double wait_ns = (edge - at) * kSector / omega * 1e9;
  if (!(wait_ns < 1e12)) return;
  next_ = std::max(system_.from_ns(now_ns + static_cast<std::int64_t>(std::ceil(wait_ns)) + 1),
                   system_.now() + 1);
}

void HallLines::run_events() {
  if (next_ <= system_.now()) look();
}

}  // namespace omnihil::mcu
