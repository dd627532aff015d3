#include "firmware_iface/mcu/board/motor_wire.h"

#include <algorithm>
#include <utility>

namespace omnihil::mcu {

void MotorWire::pass(std::int64_t at_ns) {
  const auto held_ns = static_cast<double>(at_ns - since_ns_);
  since_ns_ = at_ns;
  if (!held_.driven || held_ns <= 0.0) return;
  driven_ns_ += held_ns;
  duty_ns_ += held_ns * held_.duty_ratio;
}

// What now() would give is held_: nothing that it is made of has moved since.
inline bool MotorWire::still() const {
  return held_pwm_ && held_version_ == pins_version() && held_directed_ == directed() && enabled() &&
         !braked();
}

[[gnu::noinline]] void MotorWire::hold() {
  held_ = work_out(held_pwm_);
  held_directed_ = directed();
  if (held_pwm_) held_version_ = pins_version();
}

[[gnu::noinline]] void MotorWire::legs_changed(std::int64_t at_ns) {
  if (!legs_stay()) means_.hold(look_at_legs(), at_ns);
}

// At every update of a timer, whatever has come of it.
inline void MotorWire::changed(std::int64_t at_ns) {
  if (phases()) return legs_changed(at_ns);
  pass(at_ns);
  if (!still()) hold();
}

MotorWire::MotorWire(const MotorEntry& entry, Chip& chip, std::function<std::int64_t()> now_ns)
    : entry_(entry), now_ns_(std::move(now_ns)), phases_(entry.pwm.size() == 3) {
  const auto pin_changed = [this](bool) { changed(now_ns_()); };
  const auto listen = [this](PwmOutputs* timer) {
    if (std::find(leg_timers_.begin(), leg_timers_.end(), timer) != leg_timers_.end()) return;
    leg_timers_.push_back(timer);
    timer->on_output([this](std::int64_t at_ns) { changed(at_ns); });
  };
  for (const ChannelName& channel : entry_.pwm)
    listen(timers_.emplace_back(chip.find<PwmOutputs>(channel.timer)));
  for (const ChannelName& channel : entry_.pwm_low)
    listen(low_timers_.emplace_back(chip.find<PwmOutputs>(channel.timer)));
  if (entry_.direction) {
    direction_ = chip.port(entry_.direction->port);
    direction_->on_output(entry_.direction->pin, pin_changed);
  }
  if (entry_.enable) {
    enable_ = chip.port(entry_.enable->port);
    enable_->on_output(entry_.enable->pin, pin_changed);
  }
  if (entry_.brake) {
    brake_ = chip.port(entry_.brake->port);
    brake_->on_output(entry_.brake->pin, pin_changed);
  }
}

void MotorWire::gate_by(Device& driver) {
  driver_ = &driver;
  driver.on_bridge([this] { changed(now_ns_()); });
}

TimerPin MotorWire::pin(PwmOutputs& timer, const ChannelName& channel) const {
  TimerPin pin = timer.pin(channel.channel, channel.complement);
  if (entry_.inverted && pin.drive != TimerPin::Drive::kOff) pin.high_ratio = 1.0 - pin.high_ratio;
  return pin;
}

BridgeDrive MotorWire::work_out(bool& pwm) const {
  pwm = false;
  if (!enabled() || timers_.empty()) return {};
  if (braked()) return {true, 0.0};
  const TimerPin first = pin(0);
  if (first.drive == TimerPin::Drive::kOff) return {};
  pwm = first.drive == TimerPin::Drive::kPwm;
  if (timers_.size() == 2) {
    const TimerPin second = pin(1);
    pwm = pwm && second.drive == TimerPin::Drive::kPwm;
    if (second.drive == TimerPin::Drive::kOff) return {};
    return {true, entry_.sign * (first.high_ratio - second.high_ratio)};
  }
  if (direction_ == nullptr) return {true, entry_.sign * (2.0 * first.high_ratio - 1.0)};
  const bool forward = directed() == entry_.direction_high_is_forward;
  return {true, entry_.sign * (forward ? first.high_ratio : -first.high_ratio)};
}

void MotorWire::begin(std::int64_t at_ns) {
  since_ns_ = at_ns;
  driven_ns_ = duty_ns_ = 0.0;
  if (phases()) {
    means_.begin(legs_stay() ? means_.held() : look_at_legs(), at_ns);
  } else if (!still()) {
    hold();
  }
}

BridgeDrive MotorWire::end(std::int64_t at_ns) {
  pass(at_ns);
  if (driven_ns_ <= 0.0) return {};
  return {true, duty_ns_ / driven_ns_};
}

std::uint32_t MotorWire::leg_pins_version() const {
  std::uint32_t version = 0;
  for (const PwmOutputs* timer : leg_timers_) version += timer->pins_version();
  return version;
}

// What look_at_legs() would give is means_.held(): nothing that it is made of has moved since.
bool MotorWire::legs_stay() const {
  return legs_known_ && legs_version_ == leg_pins_version() && legs_enabled_ == enabled() &&
         legs_braked_ == braked();
}

BridgeLegs MotorWire::look_at_legs() {
  BridgeLegs now;
  legs(now.leg, now.duty_ratio);
  legs_enabled_ = enabled();
  legs_braked_ = braked();
  legs_version_ = leg_pins_version();
  const auto stays = [](PwmOutputs* timer, const ChannelName& channel) {
    return timer->pin_stays(channel.channel, channel.complement);
  };
  legs_known_ = std::equal(timers_.begin(), timers_.end(), entry_.pwm.begin(), stays) &&
                std::equal(low_timers_.begin(), low_timers_.end(), entry_.pwm_low.begin(), stays);
  return now;
}

void MotorWire::legs(std::uint32_t (&leg)[kLegs], double (&duty_ratio)[kLegs]) const {
  for (std::size_t x = 0; x < timers_.size() && x < kLegs; ++x) {
    leg[x] = OMNIHIL_LEG_OFF;
    duty_ratio[x] = 0.0;
    if (!enabled()) continue;
    if (braked()) {
      leg[x] = OMNIHIL_LEG_LOW;
      duty_ratio[x] = 1.0;
      continue;
    }
    const TimerPin high = pin(x);
    if (low_timers_.empty()) {
      if (high.drive == TimerPin::Drive::kOff) continue;
      leg[x] = OMNIHIL_LEG_PWM;
      duty_ratio[x] = high.high_ratio;
      continue;
    }
    const double upper = high.high_ratio;  // 0 of a pin that is off
    const double lower = pin(*low_timers_[x], entry_.pwm_low[x]).high_ratio;
    if (upper > 0.0 && lower > 0.0) {  // both shares are short by the same dead time
      leg[x] = OMNIHIL_LEG_PWM;
      duty_ratio[x] = 0.5 * (upper + 1.0 - lower);
    } else if (upper > 0.0) {
      leg[x] = OMNIHIL_LEG_HIGH;
      duty_ratio[x] = upper;
    } else if (lower > 0.0) {
      leg[x] = OMNIHIL_LEG_LOW;
      duty_ratio[x] = lower;
    }
  }
  if (entry_.sign >= 0 || timers_.size() < 3) return;
  std::swap(leg[1], leg[2]);
  std::swap(duty_ratio[1], duty_ratio[2]);
}

CurrentPath MotorWire::path(std::size_t phase) const {
  if (!enabled()) return CurrentPath::kDiodes;
  if (braked()) return CurrentPath::kLower;
  const std::size_t x = entry_.sign < 0 && phase > 0 ? kLegs - 1 - phase : phase;  // as the leads are swapped
  const auto driven = [this](PwmOutputs& timer, const ChannelName& channel) {
    return pin(timer, channel).drive != TimerPin::Drive::kOff;
  };
  timers_[x]->look();
  if (!low_timers_.empty()) low_timers_[x]->look();
  const bool high = driven(*timers_[x], entry_.pwm[x]);
  const bool upper = high && level(*timers_[x], entry_.pwm[x]);
  if (upper) return CurrentPath::kUpper;
  const bool lower = low_timers_.empty() ? high
                                         : driven(*low_timers_[x], entry_.pwm_low[x]) &&
                                               level(*low_timers_[x], entry_.pwm_low[x]);
  return lower ? CurrentPath::kLower : CurrentPath::kDiodes;
}

}  // namespace omnihil::mcu
