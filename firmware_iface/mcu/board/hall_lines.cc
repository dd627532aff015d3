#include "firmware_iface/mcu/board/hall_lines.h"

#include <limits>
#include <numbers>

namespace omnihil::mcu {
namespace {
constexpr double kTwoPi = 2.0 * std::numbers::pi, kSector = std::numbers::pi / 3;
}

HallLines::HallLines(const MotorEntry& entry, Chip& chip, System& system,
                     std::function<const WorldState&()> world)
    : ShaftLines("Hall lines of wheel " + std::to_string(entry.wheel), entry, entry.hall_pins, chip, system,
                 std::move(world)),
      timer_(chip.find<Timer>(entry.hall_timer)) {}

double HallLines::electric_rad(std::int64_t at_ns) const {
  return world_().rotor_rad(entry_.wheel, at_ns) * entry_.hall_pole_pairs;
}

unsigned HallLines::code(double theta_elec_rad) {
  unsigned code = 0;
  for (unsigned x = 0; x < 3; ++x) {
    const double turns = (theta_elec_rad - x * kTwoPi / 3) / kTwoPi - 210.0 / 360.0;
    if (turns - std::floor(turns) < 0.5) code |= 1u << x;
  }
  return code;
}

// The next edge is half a sector away from a multiple of one: at 30, 90, 150 … electrical degrees.
double HallLines::look(std::int64_t now_ns) {
  const double theta_elec_rad = electric_rad(now_ns);
  const unsigned is = code(theta_elec_rad) ^ (entry_.hall_inverted ? 7u : 0u);
  const unsigned changed = is ^ shown_;
  shown_ = is;
  for (unsigned x = 0; x < 3; ++x) {
    if ((changed >> x & 1u) == 0) continue;
    const bool level = (is >> x & 1u) != 0;
    drive(x, level);
    if (timer_ != nullptr) timer_->set_input(x, level);
  }
  const double omega = omega_rotor_rad_s() * entry_.hall_pole_pairs;
  if (std::abs(omega) < 1e-6) return std::numeric_limits<double>::infinity();
  const double at = theta_elec_rad / kSector - 0.5;
  constexpr double kPast = 1e-9;  // of a sector: an edge that has just been passed is not the next
  const double edge = omega > 0 ? std::floor(at + kPast) + 1.0 : std::ceil(at - kPast) - 1.0;
  return (edge - at) * kSector / omega * 1e9;
}

}  // namespace omnihil::mcu
