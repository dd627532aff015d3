#include "firmware_iface/mcu/board/encoder_lines.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace omnihil::mcu {
namespace {
constexpr std::int64_t kCatchUp_ns = 1000;
}

EncoderLines::EncoderLines(const MotorEntry& entry, Chip& chip, System& system,
                           std::function<const WorldState&()> world)
    : Peripheral("encoder lines of wheel " + std::to_string(entry.wheel)),
      entry_(entry),
      system_(system),
      world_(std::move(world)) {
  next_event_is(next_);
  for (std::size_t i = 0; i < pins_.size(); ++i)
    pins_[i] = {chip.port(entry.encoder_pins[i].port), entry.encoder_pins[i].pin};
}

std::int64_t EncoderLines::count(std::int64_t at_ns) const {
  const std::int64_t counts = world_().encoder_counts(entry_.wheel, at_ns);
  return entry_.encoder_sign < 0 ? -counts : counts;
}

void EncoderLines::show() const {
  const std::int64_t phase = shown_ & 3;
  const bool levels[] = {phase == 1 || phase == 2, phase >= 2};
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    const auto& [bank, pin] = pins_[i];
    bank->drive(pin, levels[i]);
  }
}

void EncoderLines::look() {
  const std::int64_t is = count(system_.to_ns(system_.now()));
  if (!begun_) shown_ = is;
  if (shown_ != is || !begun_) {
    shown_ += shown_ < is ? 1 : shown_ > is ? -1 : 0;
    begun_ = true;
    show();
  }
  plan();
}

void EncoderLines::world_changed() {
  const Cycles before = next_;
  look();
  if (next_ != before) system_.event_moved(&next_, before);
}

void EncoderLines::plan() {
  constexpr double kTwoPi = 6.283185307179586;
  next_ = kNever;
  const std::int64_t now_ns = system_.to_ns(system_.now());
  const WorldState& world = world_();
  if (begun_ && shown_ != count(now_ns)) {
    next_ = std::max(system_.from_ns(now_ns + kCatchUp_ns), system_.now() + 1);
    return;
  }
  const double per_rad = world.encoder_counts_per_rotor_turn / kTwoPi;
  const double rate = world.omega_rotor_rad_s[static_cast<std::size_t>(entry_.wheel)] * per_rad;
  if (std::abs(rate) < 1e-3) return;  // counts per second: none in a run
  const double at = world.rotor_rad(entry_.wheel, now_ns) * per_rad;
  const double wait_ns = (rate > 0 ? std::floor(at) + 1.0 - at : std::floor(at) - at) / rate * 1e9;
  if (!(wait_ns < 1e12)) return;
  next_ = std::max(system_.from_ns(now_ns + static_cast<std::int64_t>(std::ceil(wait_ns)) + 1),
                   system_.now() + 1);
}

}  // namespace omnihil::mcu
