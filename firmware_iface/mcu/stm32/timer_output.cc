// Compare matches and what follows from them: output references, pins, dead time, commutation.
#include "firmware_iface/mcu/stm32/timer.h"
#include "firmware_iface/mcu/stm32/timer_registers.h"

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

unsigned Timer::output_mode(unsigned channel) const {
  const std::uint32_t ccmr = commutates() ? ccmr_[channel / 2] : value(kCcmr1 + 4 * (channel / 2));
  return field(ccmr, 4 + 8 * (channel % 2), 3);
}

bool Timer::captures(unsigned channel) const {
  return field(value(kCcmr1 + 4 * (channel / 2)), 8 * (channel % 2), 2) != 0;
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
  for (unsigned c = 0; c < spec_.channels && c < kChannels; ++c) {
    if (captures(c)) continue;
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
  switch (output_mode(channel)) {
    case kForceLow:
      return false;
    case kForceHigh:
      return true;
    case kPwm1:
      return law_.pwm_active(position(), ccr_[channel]);
    case kPwm2:
      return !law_.pwm_active(position(), ccr_[channel]);
    default:
      return toggled_[channel] != 0;
  }
}

// Tells those who listen to output references of their edges.
void Timer::look_at_references() {
  const unsigned master = field(value(kCr2), 4, 3);
  for (unsigned c = 0; c < spec_.channels && c < kChannels; ++c) {
    const bool level = law_.arr > 0 && reference(c);
    if (level == (seen_reference_[c] != 0)) continue;
    seen_reference_[c] = level ? 1 : 0;
    if (context_.triggers.heard(compare_[c])) context_.triggers.fire(compare_[c], level);
    if (master == 4 + c) context_.triggers.fire(trgo_, level);
    const unsigned mode = output_mode(c);
    if (mode >= kActiveOnMatch && mode <= kToggle) outputs_changed();
  }
}

bool Timer::wants_match(unsigned c) const {
  if (captures(c)) return false;
  const unsigned mode = output_mode(c);
  return (value(kDier) & (kCompare1 << c | kCompare1Dma << c)) != 0 ||
         (c == 0 && field(value(kCr2), 4, 3) == 3 && context_.triggers.heard(trgo_)) ||
         (mode >= kActiveOnMatch && mode <= kToggle && !listeners_.empty());
}

bool Timer::wants_edges(unsigned c) const {
  if (captures(c)) return false;
  return context_.triggers.heard(compare_[c]) ||
         (field(value(kCr2), 4, 3) == 4 + c && context_.triggers.heard(trgo_));
}

Cycles Timer::next_match(unsigned channel) const {
  std::array<std::uint64_t, 2> at{};
  const unsigned n = match_positions(channel, at);
  Cycles next = kNever;
  for (unsigned i = 0; i < n; ++i) next = std::min(next, after(law_.to_position(position(), at[i])));
  return next;
}

// Candidates for a change of the reference: the matches and the wrap.
Cycles Timer::next_edge(unsigned channel) const {
  const std::uint64_t ccr = ccr_[channel];
  std::array<std::uint64_t, 3> at{0, 0, 0};
  if (law_.way == CounterLaw::Way::kCentre) {
    at[1] = std::min(ccr, law_.arr);
    at[2] = 2 * law_.arr - at[1];
  } else if (ccr <= law_.arr) {
    at[1] = law_.way == CounterLaw::Way::kDown ? law_.arr - ccr : ccr;
  }
  Cycles next = kNever;
  for (const std::uint64_t target : at) next = std::min(next, after(law_.to_position(position(), target)));
  return next;
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

TimerPin Timer::pin(unsigned c, bool complement) const {
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

TimerOutput Timer::output(unsigned channel) const {
  const double tick_s = static_cast<double>(clock_.div) / clock_.mul / system().core_hz();
  return {pin(channel, false), pin(channel, true), dead_ticks() * tick_s, period_s()};
}

void Timer::outputs_changed() {
  for (const auto& listener : listeners_) listener();
}

// COM event: preloaded enables and modes of all channels become active (six-step commutation).
void Timer::commutate() {
  ccer_ = value(kCcer);
  ccmr_ = {value(kCcmr1), value(kCcmr2)};
  raise(kCom);
  if ((value(kDier) & kComDma) != 0) context_.dma.pulse(dma_com_);
  outputs_changed();
}

}  // namespace omnihil::mcu
