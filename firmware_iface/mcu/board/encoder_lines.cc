#include "firmware_iface/mcu/board/encoder_lines.h"

#include <limits>
#include <numbers>

namespace omnihil::mcu {
namespace {
constexpr double kCatchUp_ns = 999.0;  // and one more, as every edge: 1 us
constexpr double kInfinite = std::numeric_limits<double>::infinity();
}  // namespace

EncoderLines::EncoderLines(const MotorEntry& entry, Chip& chip, System& system,
                           std::function<const WorldState&()> world)
    : ShaftLines("encoder lines of wheel " + std::to_string(entry.wheel), entry, entry.encoder_pins, chip,
                 system, std::move(world)) {}

std::int64_t EncoderLines::count(std::int64_t at_ns) const {
  const std::int64_t counts = world_().encoder_counts(entry_.wheel, at_ns);
  return entry_.encoder_sign < 0 ? -counts : counts;
}

double EncoderLines::look(std::int64_t now_ns) {
  const std::int64_t is = count(now_ns);
  if (!begun_ || shown_ != is) {
    shown_ = !begun_ ? is : shown_ < is ? shown_ + 1 : shown_ - 1;
    begun_ = true;
    const std::int64_t phase = shown_ & 3;
    drive(0, phase == 1 || phase == 2);
    drive(1, phase >= 2);
  }
  if (shown_ != is) return kCatchUp_ns;
  const double per_rad = world_().encoder_counts_per_rotor_turn / (2.0 * std::numbers::pi);
  const double rate = omega_rotor_rad_s() * per_rad;
  if (std::abs(rate) < 1e-3) return kInfinite;  // counts per second: none in a run
  const double at = world_().rotor_rad(entry_.wheel, now_ns) * per_rad;
  return (rate > 0 ? std::floor(at) + 1.0 - at : std::floor(at) - at) / rate * 1e9;
}

}  // namespace omnihil::mcu
