// What comes into a timer: shaft encoders, captured edges, triggers from other timers, the break input.
#include "firmware_iface/mcu/stm32/timer/timer.h"
#include "firmware_iface/mcu/stm32/timer/timer_registers.h"

namespace omnihil::mcu {
using namespace timer_registers;
namespace {
std::int64_t floor_div(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }
}  // namespace

void Timer::set_shaft(ShaftCount shaft) {
  shaft_ = std::move(shaft);
  shaft_zero_ = encoder() ? shaft_edges() : 0;
}

// Edges that the encoder mode counts: all four of a quadrature period, or those of one input (modes 1 and 2).
std::int64_t Timer::shaft_edges() const {
  if (!shaft_) return 0;
  std::int64_t count = shaft_(system().to_ns(now()));
  if (bit(value(kCcer), 1) != bit(value(kCcer), 5))
    count = -count;  // one input inverted: the other way round
  const unsigned mode = field(value(kSmcr), 0, 3);
  if (mode == 3) return count;
  return mode == 1 ? floor_div(count + 1, 2) : floor_div(count, 2);
}

std::int64_t Timer::unwrapped() const {
  return (value(kCr1) & kCen) != 0 ? shaft_edges() - shaft_zero_ : shaft_seen_;
}

// Afterwards shaft_seen_ is unwrapped().
void Timer::sync_encoder() {
  const std::int64_t turns = static_cast<std::int64_t>(law_.arr) + 1;
  const std::int64_t at = unwrapped();
  if (at == shaft_seen_) return;
  shaft_falling_ = at < shaft_seen_;
  const bool wrapped = (turns & (turns - 1)) == 0 ? ((at ^ shaft_seen_) & -turns) != 0
                                                  : floor_div(at, turns) != floor_div(shaft_seen_, turns);
  shaft_seen_ = at;
  if (wrapped && (value(kCr1) & kUdis) == 0) raise(kUpdate);
}

// CNT, after sync().
std::uint32_t Timer::shaft_count() const {
  const std::int64_t turns = static_cast<std::int64_t>(law_.arr) + 1;
  if ((turns & (turns - 1)) == 0) return static_cast<std::uint32_t>(shaft_seen_ & (turns - 1));
  return static_cast<std::uint32_t>((shaft_seen_ % turns + turns) % turns);
}

bool Timer::timer_input(unsigned input) const {
  if (input == 0 && bit(value(kCr2), 7)) return ((inputs_[0] ^ inputs_[1] ^ inputs_[2]) & 1) != 0;  // TI1S
  return inputs_[input] != 0;
}

void Timer::set_input(unsigned channel, bool level) {
  sync();
  std::array<bool, kChannels> before{};
  for (unsigned i = 0; i < kChannels; ++i) before[i] = timer_input(i);
  inputs_[channel] = level ? 1 : 0;
  for (unsigned i = 0; i < kChannels; ++i) {
    if (timer_input(i) != before[i]) input_edge(i, timer_input(i));
  }
  plan();
  system().reschedule();
}

// CCxP, CCxNP: 00 rising, 01 falling, 11 both.
bool Timer::selected_edge(unsigned channel, bool level) const {
  const bool p = bit(value(kCcer), 4 * channel + 1), np = bit(value(kCcer), 4 * channel + 3);
  return p && np ? true : level != p;
}

void Timer::input_edge(unsigned input, bool level) {
  for (unsigned c = 0; c < spec_.channels && c < kChannels; ++c) {
    const unsigned select = field(value(kCcmr1 + 4 * (c / 2)), 8 * (c % 2), 2);
    const bool mine = (select == 1 && input == c) || (select == 2 && input == (c ^ 1u));
    if (mine && bit(value(kCcer), 4 * c) && selected_edge(c, level)) {
      if (edges_left_[c] == 0) {
        edges_left_[c] = 1u << field(value(kCcmr1 + 4 * (c / 2)), 2 + 8 * (c % 2), 2);
        capture(c);
      }
      --edges_left_[c];
    }
  }
  const unsigned source = field(value(kSmcr), 4, 3);
  if (field(value(kSmcr), 20, 2) != 0) return;
  if (source == 4 && input == 0) trigger_edge();  // TI1F_ED: either edge
  if (source == 5 && input == 0 && selected_edge(0, level)) trigger_edge();
  if (source == 6 && input == 1 && selected_edge(1, level)) trigger_edge();
  if (field(value(kSmcr), 0, 3) == 5) follow_settings();
}

void Timer::capture(unsigned channel) {
  value(kCcr1 + 4 * channel) = encoder() ? load(kCnt) : count();
  const std::uint32_t flag = kCompare1 << channel;
  if ((value(kSr) & flag) != 0) raise(kOverCapture1 << channel);
  raise(flag);
  if ((value(kDier) & (kCompare1Dma << channel)) != 0) context_.dma.pulse(dma_channel_[channel]);
  if (channel == 0 && field(value(kCr2), 4, 3) == 3) context_.triggers.fire(trgo_, true);
}

// An active edge of the selected trigger (TRGI): captures of TRC first, then what the slave mode does.
void Timer::trigger_edge() {
  for (unsigned c = 0; c < spec_.channels && c < kChannels; ++c) {
    if (field(value(kCcmr1 + 4 * (c / 2)), 8 * (c % 2), 2) == 3 && bit(value(kCcer), 4 * c)) capture(c);
  }
  if (commutates() && bit(value(kCr2), 2)) commutate();  // CCUS
  const unsigned mode = field(value(kSmcr), 0, 3) | field(value(kSmcr), 16, 1) << 3;
  if (mode == 0 || encoder()) return;
  raise(kTrigger);
  if ((value(kDier) & kTriggerDma) != 0) context_.dma.pulse(dma_trigger_);
  if (mode == 4 || mode == 8) {
    anchor_ = now();
    start_ = done_ = 0;
    update_event(true);
    if (field(value(kCr2), 4, 3) == 0) context_.triggers.fire(trgo_, true);
  }
  if (mode == 6 || mode == 8) {
    value(kCr1) |= kCen;
    follow_settings();
  }
  if (mode == 7 && (value(kCr1) & kCen) != 0 && law_.arr > 0) {  // the trigger is the clock
    const std::uint64_t step = law_.to_boundary(position());
    mark_matches(1);
    start_ = (start_ + 1) % law_.period();
    if (step == 1) boundary();
  }
}

void Timer::triggered(int source, bool rising) {
  const unsigned selected = field(value(kSmcr), 4, 3) | field(value(kSmcr), 20, 2) << 3;
  const unsigned itr = selected < 4 ? selected : selected >= 8 ? selected - 4 : 99;
  if (!rising || itr >= internal_.size() || internal_[itr] != source) return;
  sync();
  trigger_edge();
  look_at_references();
  plan();
  system().reschedule();
}

void Timer::listen_to_triggers() {
  const unsigned selected = field(value(kSmcr), 4, 3) | field(value(kSmcr), 20, 2) << 3;
  const unsigned itr = selected < 4 ? selected : selected >= 8 ? selected - 4 : 99;
  const unsigned mode = field(value(kSmcr), 0, 3) | field(value(kSmcr), 16, 1) << 3;
  bool wants = mode >= 4;
  for (unsigned c = 0; c < kChannels; ++c) {
    wants = wants || field(value(kCcmr1 + 4 * (c / 2)), 8 * (c % 2), 2) == 3;
  }
  wants = wants || (commutates() && bit(value(kCr2), 2));
  for (std::size_t i = 0; i < internal_.size(); ++i) {
    context_.triggers.listen(internal_[i], *this, wants && i == itr);
  }
}

// While it is active, MOE cannot be set and its flag not be cleared.
bool Timer::look_at_break() {
  const std::uint32_t bdtr = value(kBdtr);
  break_high_ = (bdtr & kBke) != 0 && break_level_ == ((bdtr & kBkp) != 0);
  if (!break_high_) return false;
  value(kBdtr) &= ~kMoe;
  forget_pins();
  raise(kBreak);
  return true;
}

void Timer::break_input(bool level) {
  sync();
  break_level_ = level;
  if (!look_at_break()) return;
  plan();
  outputs_changed();
  system().reschedule();
}

}  // namespace omnihil::mcu
