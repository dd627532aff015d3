#include "firmware_iface/mcu/board/motor_wire.h"

#include <utility>

namespace omnihil::mcu {

MotorWire::MotorWire(const MotorEntry& entry, Chip& chip, std::function<std::int64_t()> now_ns)
    : entry_(entry), now_ns_(std::move(now_ns)) {
  for (const ChannelName& channel : entry_.pwm) {
    timers_.push_back(chip.find<Timer>(channel.timer));
    timers_.back()->on_output([this] { changed(); });
  }
  if (entry_.direction) {
    direction_ = chip.port(entry_.direction->port);
    direction_->on_output(entry_.direction->pin, [this](bool) { changed(); });
  }
  if (entry_.enable) {
    enable_ = chip.port(entry_.enable->port);
    enable_->on_output(entry_.enable->pin, [this](bool) { changed(); });
  }
}

TimerPin MotorWire::pin(std::size_t i) const {
  const TimerOutput out = timers_[i]->output(entry_.pwm[i].channel);
  TimerPin pin = entry_.pwm[i].complement ? out.complement : out.main;
  if (entry_.inverted && pin.drive != TimerPin::Drive::kOff) pin.high_ratio = 1.0 - pin.high_ratio;
  return pin;
}

BridgeDrive MotorWire::now() const {
  if (!enabled() || timers_.empty()) return {};
  const TimerPin first = pin(0);
  if (first.drive == TimerPin::Drive::kOff) return {};
  if (timers_.size() == 2) {
    const TimerPin second = pin(1);
    if (second.drive == TimerPin::Drive::kOff) return {};
    return {true, entry_.sign * (first.high_ratio - second.high_ratio)};
  }
  if (direction_ == nullptr) return {true, entry_.sign * (2.0 * first.high_ratio - 1.0)};
  const bool forward = direction_->output(entry_.direction->pin) == entry_.direction_high_is_forward;
  return {true, entry_.sign * (forward ? first.high_ratio : -first.high_ratio)};
}

void MotorWire::pass(std::int64_t at_ns) {
  const auto held_ns = static_cast<double>(at_ns - since_ns_);
  since_ns_ = at_ns;
  if (!held_.driven || held_ns <= 0.0) return;
  driven_ns_ += held_ns;
  duty_ns_ += held_ns * held_.duty_ratio;
}

void MotorWire::changed() {
  if (phases()) return;
  pass(now_ns_());
  held_ = now();
}

void MotorWire::begin(std::int64_t at_ns) {
  since_ns_ = at_ns;
  driven_ns_ = duty_ns_ = 0.0;
  held_ = phases() ? BridgeDrive{} : now();
}

BridgeDrive MotorWire::end(std::int64_t at_ns) {
  pass(at_ns);
  if (driven_ns_ <= 0.0) return {};
  return {true, duty_ns_ / driven_ns_};
}

void MotorWire::legs(std::uint32_t (&leg)[kLegs], double (&duty_ratio)[kLegs]) const {
  using Drive = TimerPin::Drive;
  for (std::size_t x = 0; x < timers_.size() && x < kLegs; ++x) {
    leg[x] = OMNIHIL_LEG_OFF;
    duty_ratio[x] = 0.0;
    if (!enabled()) continue;
    const TimerPin high = pin(x);
    const TimerPin low = timers_[x]->output(entry_.pwm[x].channel).complement;
    const bool high_on = high.drive != Drive::kOff, low_on = low.drive != Drive::kOff;
    if (high_on && low_on) {
      const bool both_idle = high.high_ratio <= 0.0 && low.high_ratio <= 0.0;
      const bool only_high = low.drive == Drive::kSteady && low.high_ratio <= 0.0;
      leg[x] = both_idle ? OMNIHIL_LEG_OFF : only_high ? OMNIHIL_LEG_HIGH : OMNIHIL_LEG_PWM;
      duty_ratio[x] = high.high_ratio;
    } else if (high_on) {  // no complementary output: the driver makes it of the one input
      leg[x] = OMNIHIL_LEG_PWM;
      duty_ratio[x] = high.high_ratio;
    } else if (low_on) {
      leg[x] = OMNIHIL_LEG_LOW;
      duty_ratio[x] = low.high_ratio;
    }
  }
  if (entry_.sign >= 0 || timers_.size() < 3) return;
  std::swap(leg[1], leg[2]);
  std::swap(duty_ratio[1], duty_ratio[2]);
}

}  // namespace omnihil::mcu
