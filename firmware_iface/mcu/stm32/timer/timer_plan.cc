// When a timer has to be looked at again: what somebody waits for.
#include "firmware_iface/mcu/stm32/timer/timer.h"
#include "firmware_iface/mcu/stm32/timer/timer_registers.h"

namespace omnihil::mcu {
using namespace timer_registers;

// After every change of a preload register, of what it is preloaded for, or of which channels are inputs.
void Timer::note_preloads() {
  preloaded_ = prescale_ != value(kPsc) + 1u || law_.arr != value(kArr) ? 1u << kChannels : 0u;
  for (unsigned c = 0; c < kChannels; ++c) {
    if (!captures(c) && ccr_[c] != value(kCcr1 + 4 * c)) preloaded_ |= 1u << c;
  }
}

// A bit for each channel whose matches, or edges of its reference, somebody waits for.
std::uint32_t Timer::awaited_matches() const {
  std::uint32_t wanted = value(kDier) / kCompare1 | value(kDier) / kCompare1Dma;
  if (field(value(kCr2), 4, 3) == 3 && context_.triggers.heard(trgo_)) wanted |= 1u;
  if (!listeners_.empty()) wanted |= acting_;
  return wanted & outputs_;
}

std::uint32_t Timer::heard_edges() const {
  if (heard_version_ != context_.triggers.version()) {
    heard_ = find_heard_edges();
    heard_version_ = context_.triggers.version();
  }
  return heard_;
}

// Who begins to listen hears of edges from now on, not of one that nobody asked for before.
void Timer::heard_changed() {
  const std::uint32_t before = heard_, fresh = find_heard_edges() & ~before;
  if (fresh != 0 && running_ && now() >= anchor_) {
    const std::uint32_t levels = references_at((start_ + ticks_at(now())) % law_.period());
    seen_references_ = (seen_references_ & ~fresh) | (levels & fresh);
  }
  plan();
}

std::uint32_t Timer::find_heard_edges() const {
  std::uint32_t wanted = 0;
  for (unsigned c = 0; c < kChannels; ++c) {
    if (context_.triggers.heard(compare_[c])) wanted |= 1u << c;
  }
  const unsigned master = field(value(kCr2), 4, 3);
  if (master >= 4 && context_.triggers.heard(trgo_)) wanted |= 1u << (master - 4);
  return wanted;
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

// The next instant that somebody waits for.
void Timer::plan() {
  next_ = kNever;
  update_alone_ = true;
  heard_then_ = context_.triggers.version();
  const std::uint32_t dier = value(kDier);
  if (encoder()) {
    constexpr std::int64_t kLook_ns = 50'000;  // how late an overflow interrupt may come
    if ((dier & kUpdate) != 0 && (value(kCr1) & kCen) != 0) {
      next_ = system().from_ns((system().to_ns(now()) / kLook_ns + 1) * kLook_ns);
      if (next_ <= now()) next_ = now() + 1;
    }
    return;
  }
  if (!running_) return;
  const bool update = (dier & (kUpdate | kUpdateDma)) != 0 || (value(kCr1) & kOpm) != 0 ||
                      (field(value(kCr2), 4, 3) == 2 && context_.triggers.heard(trgo_)) ||
                      (!listeners_.empty() && (transfer_pending() || (value(kBdtr) & kAoe) != 0));
  if (update) next_ = after(law_.to_boundary(position()));
  if (outputs_ != 0) {
    const std::uint32_t matches = awaited_matches(), edges = heard_edges() & outputs_;
    update_alone_ = (matches | edges) == 0;
    for (unsigned c = 0; (matches | edges) >> c != 0; ++c) {
      if ((matches >> c & 1u) != 0) next_ = std::min(next_, next_match(c));
      if ((edges >> c & 1u) != 0) next_ = std::min(next_, next_edge(c));
    }
  }
  if (next_ <= now()) next_ = now() + 1;  // ticks faster than the core clock
}

// Polled flags and counts: until the next end of the count, match or tick.
Cycles Timer::stable_until(std::uint32_t offset) const {
  offset &= ~3u;
  const bool capturing = offset >= kCcr1 && offset < kCcr1 + 16 && captures((offset - kCcr1) / 4);
  if (capturing || offset == kDmar || offset == kNewDmar) return 0;
  if (offset != kCnt && offset != kSr && offset != kCr1) return kNever;
  if (encoder()) return 0;
  if (!running_) return kNever;
  if (now() < anchor_) return 0;
  if (offset == kCnt) return cycle_of(ticks_at(now()) + 1);
  Cycles until = after(law_.to_boundary(position()));
  for (unsigned c = 0; c < spec_.channels && c < kChannels; ++c) {
    if (!captures(c)) until = std::min(until, next_match(c));
  }
  return until;
}

}  // namespace omnihil::mcu
