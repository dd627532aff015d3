#include "firmware_iface/mcu/rp2040/timer.h"

#include <algorithm>

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint32_t {
  kTimeHw = 0x00,
  kTimeLw = 0x04,
  kTimeHr = 0x08,
  kTimeLr = 0x0C,
  kAlarm = 0x10,
  kArmed = 0x20,
  kRawH = 0x24,
  kRawL = 0x28,
  kPause = 0x30,
  kIntr = 0x34,
  kInte = 0x38,
  kIntf = 0x3C,
  kInts = 0x40
};
constexpr RegisterInfo kRegisters[] = {
    {kTimeHw, "TIMEHW", 0, 0}, {kTimeLw, "TIMELW", 0, 0}, {kTimeHr, "TIMEHR", 0, 0},
    {kTimeLr, "TIMELR", 0, 0}, {0x10, "ALARM0"},          {0x14, "ALARM1"},
    {0x18, "ALARM2"},          {0x1C, "ALARM3"},          {kArmed, "ARMED", 0, 0},
    {kRawH, "TIMERAWH", 0, 0}, {kRawL, "TIMERAWL", 0, 0}, {0x2C, "DBGPAUSE", 7, 6},
    {kPause, "PAUSE", 0, 1},   {kIntr, "INTR", 0, 0},     {kInte, "INTE", 0, 15},
    {kIntf, "INTF", 0, 15},    {kInts, "INTS", 0, 0}};
constexpr unsigned kAlarms = 4;
}  // namespace

RpTimer::RpTimer(Watchdog& watchdog, ChipContext& context)
    : Rp2040Block("TIMER", context.system, kRegisters),
      watchdog_(watchdog),
      lines_{IrqLine{context.irqs, 0}, IrqLine{context.irqs, 1}, IrqLine{context.irqs, 2},
             IrqLine{context.irqs, 3}} {
  next_event_is(next_);
  watchdog.on_tick([this] {
    const Cycles before = next_;
    follow_rate();
    if (next_ != before) this->system().event_moved(&next_, before);
  });
}

void RpTimer::reset() {
  Rp2040Block::reset();
  count_ = {};
  count_.set(0, now());
  armed_ = latched_high_ = written_low_ = 0;
  interrupts_ = {};
  follow_rate();
  update();
}

void RpTimer::follow_rate() {
  count_.rate(bit(value(kPause), 0) ? ClockRatio{0, 1} : watchdog_.tick(), now());
  plan();
}

void RpTimer::plan() {
  next_ = kNever;
  for (unsigned i = 0; i < kAlarms; ++i) {
    if (bit(armed_, i)) next_ = std::min(next_, count_.when(due_[i], now()));
  }
}

void RpTimer::run_events() {
  if (next_ > now()) return;
  const std::uint64_t at = time();
  for (unsigned i = 0; i < kAlarms; ++i) {
    if (!bit(armed_, i) || due_[i] > at) continue;
    armed_ &= ~(1u << i);
    interrupts_.raw |= 1u << i;
  }
  plan();
  update();
}

void RpTimer::update() {
  const std::uint32_t shown = interrupts_.shown();
  for (unsigned i = 0; i < kAlarms; ++i) lines_[i].set(bit(shown, i));
}

// The time moves at its next tick; what of it is read tells no more than that.
Cycles RpTimer::stable_until(std::uint32_t offset) const {
  const std::uint32_t at = offset & 0xFFCu;
  if (at == kTimeHr || at == kTimeLr) return 0;  // latches
  return at == kRawH || at == kRawL ? count_.when(time() + 1, now()) : kNever;
}

std::uint32_t RpTimer::load(std::uint32_t offset) {
  if (offset == kTimeLr) latched_high_ = static_cast<std::uint32_t>(time() >> 32);
  return shown(offset);
}

std::uint32_t RpTimer::shown(std::uint32_t offset) {
  switch (offset) {
    case kTimeHr:
      return latched_high_;
    case kTimeLr:
    case kRawL:
      return static_cast<std::uint32_t>(time());
    case kRawH:
      return static_cast<std::uint32_t>(time() >> 32);
    case kArmed:
      return armed_;
    case kIntr:
      return interrupts_.raw;
    case kInte:
      return interrupts_.enabled;
    case kIntf:
      return interrupts_.forced;
    case kInts:
      return interrupts_.shown();
    default:
      return value(offset);
  }
}

void RpTimer::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset >= kAlarm && offset < kArmed) {
    keep(offset, written, lanes);
    const unsigned i = (offset - kAlarm) / 4;
    const std::uint64_t at = time();
    // The next time that the low word is this: at once is a whole turn away.
    const std::uint32_t ahead = written - static_cast<std::uint32_t>(at);
    due_[i] = at + (ahead == 0 ? std::uint64_t{1} << 32 : ahead);
    armed_ |= 1u << i;
  } else if (offset == kArmed) {
    armed_ &= ~written;
  } else if (offset == kTimeLw) {
    written_low_ = written;
  } else if (offset == kTimeHw) {
    count_.set(std::uint64_t{written} << 32 | written_low_, now());
  } else if (offset == kIntr) {
    interrupts_.raw &= ~written;
  } else if (offset == kInte) {
    interrupts_.enabled = written & 15u;
  } else if (offset == kIntf) {
    interrupts_.forced = written & 15u;
  } else {
    keep(offset, written, lanes);
    if (offset == kPause) return follow_rate();
  }
  plan();
  update();
}

}  // namespace omnihil::mcu::rp2040
