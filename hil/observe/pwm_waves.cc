#include "hil/observe/pwm_waves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace omnihil {
namespace {

constexpr unsigned kChannels = 4;

struct Pin {
  int level = -1, duty = -1;
  std::int64_t rises_ns = -1;  // its dead time is running; below 0: it is not
};

}  // namespace

class PwmWaves::OfTimer final : public mcu::TriggerSink {
 public:
  OfTimer(mcu::McuBoard& board, mcu::Timer& timer, WaveLog& log, const std::string& scope)
      : board_(board), timer_(timer), log_(log) {
    for (unsigned c = 0; c < channels(); ++c) {
      edges_[c] = board.chip().context().triggers.source(fmt::format("{}_CC{}", timer.name(), c + 1));
      for (unsigned side = 0; side < (timer.spec().advanced && c < 3 ? 2u : 1u); ++side) {
        const std::string name = fmt::format("{}_CH{}{}", timer.name(), c + 1, side != 0 ? "N" : "");
        pins_[c][side] = {log.add(scope, name, WaveKind::kLevel),
                          log.add(scope, name + "_duty", WaveKind::kReal)};
      }
    }
    timer.on_output([this](std::int64_t at_ns) {
      for (unsigned c = 0; c < channels(); ++c) look(c, at_ns);
    });
  }

  void triggered(int source, bool) override {
    for (unsigned c = 0; c < channels(); ++c)
      if (edges_[c] == source) look(c, board_.now_ns());
  }

  void finish() {
    for (auto& channel : pins_)
      for (Pin& pin : channel) rise(pin);
  }

 private:
  unsigned channels() const { return std::min(timer_.spec().channels, kChannels); }

  void look(unsigned channel, std::int64_t at_ns) {
    bool pwm = false;
    for (unsigned side = 0; side < 2; ++side) {
      Pin& pin = pins_[channel][side];
      if (pin.level < 0 && pin.duty < 0) continue;
      const mcu::TimerPin is = timer_.pin(channel, side != 0);
      if (is.drive == mcu::TimerPin::Drive::kOff) {
        set_off(pin, at_ns);
        continue;
      }
      pwm = pwm || (is.drive == mcu::TimerPin::Drive::kPwm && pin.level >= 0);
      log_.put_real(pin.duty, at_ns, is.high_ratio);
      if (pin.level >= 0) set(pin, channel, timer_.level(channel, side != 0), is, at_ns);
    }
    board_.chip().context().triggers.listen(edges_[channel], *this, pwm);
  }

  void set_off(Pin& pin, std::int64_t at_ns) {
    pin.rises_ns = -1;
    if (pin.level >= 0) log_.put_none(pin.level, at_ns);
    if (pin.duty >= 0) log_.put_none(pin.duty, at_ns);
  }

  // A rising edge comes late by the dead time, or not at all where the pin falls before.
  void set(Pin& pin, unsigned channel, bool high, const mcu::TimerPin& is, std::int64_t at_ns) {
    if (pin.rises_ns >= 0 && pin.rises_ns <= at_ns) rise(pin);
    if (!high) {
      pin.rises_ns = -1;
      return log_.put(pin.level, at_ns, 0);
    }
    if (pin.rises_ns >= 0) return;
    const bool was_high = log_.signals()[static_cast<std::size_t>(pin.level)].last == WaveValue{1, false};
    const bool late = is.drive == mcu::TimerPin::Drive::kPwm && timer_.paired(channel) && !was_high;
    const double dead_s = late ? timer_.output(channel).dead_time_s : 0.0;
    pin.rises_ns = at_ns + std::llround(dead_s * 1e9);
    if (pin.rises_ns <= at_ns) rise(pin);
  }

  void rise(Pin& pin) {
    if (pin.rises_ns >= 0) log_.put(pin.level, pin.rises_ns, 1);
    pin.rises_ns = -1;
  }

  mcu::McuBoard& board_;
  mcu::Timer& timer_;
  WaveLog& log_;
  std::array<int, kChannels> edges_{};
  std::array<std::array<Pin, 2>, kChannels> pins_{};
};

namespace {

// What a motor's bridge does, whenever one of its timers or pins has changed.
void watch_wheel(mcu::McuBoard& board, mcu::MotorWire& wire, WaveLog& log, const std::string& scope) {
  const mcu::MotorEntry& entry = wire.entry();
  const std::string name = fmt::format("wheel{}_", entry.wheel);
  std::array<int, kLegs> legs{-1, -1, -1};
  int driven = -1, duty = -1;
  if (wire.phases()) {
    for (std::size_t x = 0; x < kLegs; ++x)
      legs[x] = log.add(scope, name + static_cast<char>('a' + x), WaveKind::kReal);
  } else {
    driven = log.add(scope, name + "driven", WaveKind::kLevel, 1, {0, false}, true);
    duty = log.add(scope, name + "duty", WaveKind::kReal, 64, {0, false}, true);
  }
  const auto look = [&wire, &log, legs, driven, duty](std::int64_t at_ns) {
    if (wire.phases()) {
      std::uint32_t modes[kLegs]{};
      double ratios[kLegs]{};
      wire.legs(modes, ratios);
      for (std::size_t x = 0; x < kLegs; ++x) log.put_real(legs[x], at_ns, ratios[x]);
      return;
    }
    const mcu::BridgeDrive now = wire.now();
    log.put(driven, at_ns, now.driven ? 1 : 0);
    log.put_real(duty, at_ns, now.duty_ratio);
  };
  for (const auto& channels : {entry.pwm, entry.pwm_low}) {
    for (const mcu::ChannelName& channel : channels)
      board.chip().find<mcu::PwmOutputs>(channel.timer)->on_output(look);
  }
  for (const std::optional<mcu::PinName>& pin : {entry.direction, entry.enable}) {
    if (pin)
      board.chip().port(pin->port)->on_output(pin->pin, [look, &board](bool) { look(board.now_ns()); });
  }
}

}  // namespace

PwmWaves::PwmWaves(mcu::McuBoard& board, WaveLog& log, const std::string& scope) {
  for (const mcu::MotorEntry& motor : board.spec().motors)
    watch_wheel(board, *board.wire(motor.wheel), log, scope);
  for (const std::string& name : board.chip().names<mcu::Timer>()) {
    mcu::Timer& timer = *board.chip().find<mcu::Timer>(name);
    if (timer.spec().channels > 0) timers_.push_back(std::make_unique<OfTimer>(board, timer, log, scope));
  }
}

PwmWaves::~PwmWaves() = default;

void PwmWaves::finish() {
  for (const auto& timer : timers_) timer->finish();
}

}  // namespace omnihil
