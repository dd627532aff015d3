// Compare matches and what follows from them: output references, pins, dead time, commutation.
#include "firmware_iface/mcu/stm32/timer/timer.h"
#include "firmware_iface/mcu/stm32/timer/timer_registers.h"

namespace omnihil::mcu {
using namespace timer_registers;

namespace {
enum OutputMode : unsigned {
  kFrozen,
  kActiveOnMatch,
  kInactiveOnMatch,
  kToggle,
  kForceLow,
  kForceHigh,
  kPwm1,
  kPwm2
};
}

// After every change of CR2, SMCR, CCMR or DIER: what they make of each channel. Pins are worked out anew.
void Timer::note_settings() {
  forget_pins();
  captures_ = flag_only_ = acting_ = 0;
  for (unsigned c = 0; c < kChannels; ++c) {
    const std::uint32_t ccmr = value(kCcmr1 + 4 * (c / 2)), active = commutates() ? ccmr_[c / 2] : ccmr;
    mode_[c] = static_cast<std::uint8_t>(field(active, 4 + 8 * (c % 2), 3));
    if (field(ccmr, 8 * (c % 2), 2) != 0) captures_ |= 1u << c;
    if (mode_[c] >= kActiveOnMatch && mode_[c] <= kToggle) acting_ |= 1u << c;
    const bool tells = c == 0 && field(value(kCr2), 4, 3) == 3;
    if (!acts_on_match(c) && !tells && (value(kDier) & (kCompare1Dma << c)) == 0) flag_only_ |= 1u << c;
  }
  outputs_ = ~captures_ & ((1u << std::min(spec_.channels, kChannels)) - 1u);
  const unsigned slave = field(value(kSmcr), 0, 3);
  encoder_ = slave >= 1 && slave <= 3 && !bit(value(kSmcr), 16);
  heard_version_ = ~context_.triggers.version();
  note_preloads();
}

// Where in the period the counter equals CCR; the number of places.
unsigned Timer::match_positions(unsigned channel, std::array<std::uint64_t, 2>& at) const {
  const std::uint64_t ccr = ccr_[channel];
  if (law_.way == CounterLaw::Way::kDown) {
    at[0] = ccr > law_.arr ? 0 : law_.arr - ccr;
    return 1;
  }
  if (law_.way == CounterLaw::Way::kUp) {
    at[0] = ccr > law_.arr ? 0 : ccr;  // above ARR: the flag comes with the overflow
    return 1;
  }
  const unsigned flags = field(value(kCr1), 5, 2);  // 1: counting down only, 2: up only, 3: both
  unsigned n = 0;
  const std::uint64_t within = std::min(ccr, law_.arr);
  if ((flags & 2u) != 0) at[n++] = within;
  if ((flags & 1u) != 0 && (n == 0 || (within != 0 && within != law_.arr)))
    at[n++] = (2 * law_.arr - within) % law_.period();
  return n;
}

void Timer::mark_matches(std::uint64_t ticks) {
  const std::uint32_t raised = value(kSr) / kCompare1;
  const std::uint32_t rest = outputs_ & ~(flag_only_ & raised);  // of the others nothing more can follow
  for (unsigned c = 0; rest >> c != 0; ++c) {
    if ((rest >> c & 1u) == 0) continue;
    std::array<std::uint64_t, 2> at{};
    const unsigned n = match_positions(c, at);
    for (unsigned i = 0; i < n; ++i) {
      if (law_.to_position(position(), at[i]) <= ticks) matched(c);
    }
  }
}

void Timer::matched(unsigned channel) {
  switch (output_mode(channel)) {
    case kActiveOnMatch:
      toggled_[channel] = 1;
      break;
    case kInactiveOnMatch:
      toggled_[channel] = 0;
      break;
    case kToggle:
      toggled_[channel] ^= 1;
      break;
    default:
      break;
  }
  raise(kCompare1 << channel);
  if ((value(kDier) & (kCompare1Dma << channel)) != 0) context_.dma.pulse(dma_channel_[channel]);
  if (channel == 0 && field(value(kCr2), 4, 3) == 3) context_.triggers.fire(trgo_, true);
}

bool Timer::reference(unsigned channel) const {
  return reference_of(channel, law_.falling(position()), law_.count(position()));
}

inline bool Timer::reference_of(unsigned channel, bool falling, std::uint64_t count) const {
  switch (output_mode(channel)) {
    case kForceLow:
      return false;
    case kForceHigh:
      return true;
    case kPwm1:
      return law_.pwm_active(falling, count, ccr_[channel]);
    case kPwm2:
      return !law_.pwm_active(falling, count, ccr_[channel]);
    default:
      return toggled_[channel] != 0;
  }
}

// A bit per channel.
std::uint32_t Timer::references_at(std::uint64_t at) const {
  if (law_.arr == 0) return 0;
  const bool falling = law_.falling(at);
  const std::uint64_t count = law_.count(at);
  std::uint32_t levels = 0;
  for (unsigned c = 0; c < spec_.channels && c < kChannels; ++c) {
    if (reference_of(c, falling, count)) levels |= 1u << c;
  }
  return levels;
}

// Tells those who listen to output references of their edges.
void Timer::look_at_references() {
  if (spec_.channels == 0) return;
  const std::uint32_t levels = references_at(position()), moved = levels ^ seen_references_;
  if (moved == 0) return;
  if ((moved & (acting_ | heard_edges())) == 0) {  // nobody asks
    seen_references_ = levels;
    return;
  }
  std::uint32_t now_there = levels;
  for (unsigned c = 0; c < spec_.channels && c < kChannels; ++c) {
    if (((now_there ^ seen_references_) >> c & 1u) == 0) continue;
    reference_moved(c, (now_there >> c & 1u) != 0);
    now_there = references_at(position());  // a listener may be the timer itself, and move it
  }
}

void Timer::reference_moved(unsigned c, bool level) {
  seen_references_ ^= 1u << c;
  if (context_.triggers.heard(compare_[c])) context_.triggers.fire(compare_[c], level);
  if (field(value(kCr2), 4, 3) == 4 + c) context_.triggers.fire(trgo_, level);
  if (acts_on_match(c)) outputs_changed();
}

// Dead time in ticks of the timer's clock before its prescaler (RM0090 §17.4.18, DTG).
double Timer::dead_ticks() const {
  if (!spec_.advanced) return 0.0;
  const std::uint32_t dtg = field(value(kBdtr), 0, 8);
  const double unit = 1u << field(value(kCr1), 8, 2);  // CKD
  if (dtg < 0x80) return unit * dtg;
  if (dtg < 0xC0) return unit * 2.0 * (64 + (dtg & 0x3Fu));
  if (dtg < 0xE0) return unit * 8.0 * (32 + (dtg & 0x1Fu));
  return unit * 16.0 * (32 + (dtg & 0x1Fu));
}

TimerPin Timer::find_pin(unsigned c, bool complement) const {
  const unsigned i = 2 * c + (complement ? 1 : 0);
  if (!complement && is_plain_pwm(c)) {
    pins_known_ |= 1u << i;
    return pins_[i] = {TimerPin::Drive::kPwm, law_.pwm_ratio(ccr_[c])};
  }
  const TimerPin is = work_out_pin(c, complement);
  pins_[i] = is;
  // Steady ones may change with the count, but for those that are forced.
  const unsigned mode = output_mode(c);
  const bool forced = mode == kForceLow || mode == kForceHigh;
  if (is.drive != TimerPin::Drive::kSteady || forced) pins_known_ |= 1u << i;
  return is;
}

// Of mode 1, neither paired nor inverted: most of those that are written to, apart because it costs a third.
bool Timer::is_plain_pwm(unsigned c) const {
  return output_mode(c) == kPwm1 && running_ && (enable_bits() >> 4 * c & 0xFu) == 1 &&
         (!spec_.advanced || (value(kBdtr) & kMoe) != 0);
}

TimerPin Timer::work_out_pin(unsigned c, bool complement) const {
  const std::uint32_t ccer = enable_bits(), bdtr = value(kBdtr), cr2 = value(kCr2);
  const bool on = bit(ccer, 4 * c), on_n = bit(ccer, 4 * c + 2);
  const bool inverted = bit(ccer, 4 * c + (complement ? 3 : 1));
  const bool enabled = complement ? on_n : on;
  const auto steady = [](bool high) { return TimerPin{TimerPin::Drive::kSteady, high ? 1.0 : 0.0}; };
  if (complement && (!spec_.advanced || c > 2)) return {};
  if (spec_.advanced && (bdtr & kMoe) == 0) {
    // Outputs disabled: off, or at their idle levels where OSSI keeps them driven.
    if ((bdtr & kOssi) == 0 || !(on || on_n)) return {};
    return steady(bit(cr2, 8 + 2 * c + (complement ? 1 : 0)));
  }
  if (!enabled) {
    // Off; where the pair has a side that runs and OSSR is set: driven inactive.
    return spec_.advanced && (bdtr & kOssr) != 0 && (on || on_n) ? steady(inverted) : TimerPin{};
  }
  const bool pair = on && on_n;
  const unsigned mode = output_mode(c);
  if (mode < kPwm1 || !running_) return steady((reference(c) != (complement && pair)) != inverted);
  double active = law_.pwm_ratio(ccr_[c]);
  if (mode == kPwm2) active = 1.0 - active;
  if (complement && pair) active = 1.0 - active;
  if (pair && active > 0.0 && active < 1.0) {  // its rising edge comes late by the dead time
    active = std::max(0.0, active - dead_ticks() / static_cast<double>(law_.period() * prescale_));
  }
  return {TimerPin::Drive::kPwm, inverted ? 1.0 - active : active};
}

bool Timer::level(unsigned channel, bool complement) const {
  const TimerPin is = pin(channel, complement);
  if (is.drive != TimerPin::Drive::kPwm) return is.high_ratio > 0.5;
  const bool inverted = bit(enable_bits(), 4 * channel + (complement ? 3 : 1));
  return (reference(channel) != (complement && paired(channel))) != inverted;
}

TimerOutput Timer::output(unsigned channel) const {
  const double tick_s = static_cast<double>(clock_.div) / clock_.mul / system().core_hz();
  return {pin(channel, false), pin(channel, true), dead_ticks() * tick_s, period_s()};
}

void Timer::outputs_changed() {
  if (listeners_.empty()) return;
  const std::int64_t now_ns = system().to_ns(now());
  for (const auto& listener : listeners_) listener(now_ns);
}

// COM event: preloaded enables and modes of all channels become active (six-step commutation).
void Timer::commutate() {
  ccer_ = value(kCcer);
  ccmr_ = {value(kCcmr1), value(kCcmr2)};
  note_settings();
  raise(kCom);
  if ((value(kDier) & kComDma) != 0) context_.dma.pulse(dma_com_);
  outputs_changed();
}

}  // namespace omnihil::mcu
