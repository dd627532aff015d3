#include "firmware_iface/mcu/stm32/timer/timer.h"

#include "firmware_iface/mcu/stm32/register_rows.h"
#include "firmware_iface/mcu/stm32/timer/timer_registers.h"

namespace omnihil::mcu {
using namespace timer_registers;
namespace {
constexpr Cycles kNoTicks = 0;

// F0 to F7 first, then G4.
constexpr RegisterInfo kControl[] = {{kCr1, "CR1", 0, 0x0BFF, 0x0800},
                                     {kCr2, "CR2", 0, 0x00FF7FFD, 0x00F00000},
                                     {kSmcr, "SMCR", 0, 0x0031FFFF, 0x0000FF08},
                                     {kDier, "DIER", 0, 0x7FFF}};
constexpr RegisterInfo kNewControl[] = {{kCr1, "CR1", 0, 0x1BFF, 0x1800},
                                        {kCr2, "CR2", 0, 0x02FF7FFD, 0x02F00000},
                                        {kSmcr, "SMCR", 0, 0x0331FFFF, 0x0300FF08},
                                        {kDier, "DIER", 0, 0x00F07FFF, 0x00F00000}};
constexpr RegisterInfo kCounting[] = {{kSr, "SR", 0, 0},
                                      {kEgr, "EGR", 0, 0},
                                      {kCcmr1, "CCMR1", 0, 0x0101FFFF, 0x01018080},
                                      {kCcmr2, "CCMR2", 0, 0x0101FFFF, 0x01018080},
                                      {kCcer, "CCER", 0, 0x0000FFFF},
                                      {kCnt, "CNT", 0},
                                      {kPsc, "PSC", 0, 0xFFFF},
                                      {kArr, "ARR", 0xFFFFFFFF},
                                      {kRcr, "RCR", 0, 0xFFFF},
                                      {0x34, "CCR1"},
                                      {0x38, "CCR2"},
                                      {0x3C, "CCR3"},
                                      {0x40, "CCR4"}};
constexpr RegisterInfo kRest[] = {{kBdtr, "BDTR", 0, 0x0FFFFFFF, 0x0FFF0300},
                                  {kDcr, "DCR", 0, 0x1F1F},
                                  {kDmar, "DMAR", 0, 0},
                                  {0x50, "OR"},
                                  {0x54, "CCMR3", 0, 0x0101FCFC, 0xFFFFFFFF},
                                  {0x58, "CCR5"},
                                  {0x5C, "CCR6"},
                                  {0x60, "AF1", 1},
                                  {0x64, "AF2", 1}};
constexpr RegisterInfo kNewRest[] = {{kBdtr, "BDTR", 0, 0x3FFFFFFF, 0x3FFF0300},
                                     {0x48, "CCR5"},
                                     {0x4C, "CCR6"},
                                     {0x50, "CCMR3", 0, 0x0101FCFC, 0xFFFFFFFF},
                                     {0x54, "DTR2", 0, 0x300FF, 0x30000},
                                     {0x58, "ECR", 0, 0xFFFFFFFF, 0xFFFFFFFF},
                                     {0x5C, "TISEL", 0, 0x0F0F0F0F, 0x0F0F0F0F},
                                     {0x60, "AF1", 1},
                                     {0x64, "AF2", 1},
                                     {kNewDcr, "DCR", 0, 0x1F1F},
                                     {kNewDmar, "DMAR", 0, 0}};
constexpr RegisterInfo kInputs[] = {{0x68, "TISEL", 0, 0x0F0F0F0F, 0x0F0F0F0F}};
constexpr auto kCommon = joined(kControl, kCounting, kRest);
constexpr auto kSelecting = joined(kControl, kCounting, kRest, kInputs);
constexpr auto kNew = joined(kNewControl, kCounting, kNewRest);

std::string timer_name(int number) { return "TIM" + std::to_string(number); }
std::span<const RegisterInfo> rows_of(const TimerSpec& spec) {
  if (spec.new_layout) return kNew;
  return spec.selects_inputs ? std::span<const RegisterInfo>(kSelecting) : kCommon;
}
int or_update(int irq, const TimerSpec& spec) { return irq < 0 ? spec.irq_update : irq; }
}  // namespace

Timer::Timer(TimerSpec spec, ChipContext& context)
    : RegisterBlock(timer_name(spec.number), context.system, rows_of(spec)),
      spec_(std::move(spec)),
      context_(context),
      irq_update_(context.irqs, spec_.irq_update),
      irq_compare_(context.irqs, or_update(spec_.irq_compare, spec_)),
      irq_break_(context.irqs, or_update(spec_.irq_break, spec_)),
      irq_trigger_(context.irqs, or_update(spec_.irq_trigger, spec_)) {
  next_event_is(next_);
  trgo_ = context.triggers.source(name() + "_TRGO", this);
  dma_update_ = context.dma.line(name() + "_UP");
  dma_trigger_ = context.dma.line(name() + "_TRIG");
  dma_com_ = context.dma.line(name() + "_COM");
  for (unsigned c = 0; c < kChannels; ++c) {
    const std::string number = std::to_string(c + 1);
    compare_[c] = context.triggers.source(name() + "_CC" + number, this);
    dma_channel_[c] = context.dma.line(name() + "_CH" + number);
  }
  for (const std::string& from : spec_.internal_triggers) internal_.push_back(context.triggers.source(from));
  context.clocks.listen(*this);
  Timer::reset();
}

void Timer::reset() {
  RegisterBlock::reset();
  if (!spec_.bits32) value(kArr) = 0xFFFF;
  clock_ = spec_.fast_clock && context_.clocks.state().fast_timers_on ? context_.clocks.state().fast_timers
                                                                      : context_.clocks.timers(spec_.bus);
  running_ = break_high_ = false;
  anchor_ = now();
  start_ = done_ = repeat_left_ = 0;
  ccr_.fill(0);
  toggled_.fill(0);
  seen_references_ = 0;
  ccer_ = 0;
  ccmr_.fill(0);
  note_settings();
  shaft_zero_ = shaft_seen_ = 0;
  edges_left_.fill(0);
  transfer();
  follow_settings();
  update_irqs();
  outputs_changed();
}

std::uint64_t Timer::ticks_at(Cycles at) const {
  if (at <= anchor_) return kNoTicks;
  const std::uint64_t clocks = (at - anchor_) * clock_.mul, each = prescale_ * clock_.div;
  return each == 1 ? clocks : clocks / each;  // a division waits longer than all the rest takes
}

Cycles Timer::cycle_of(std::uint64_t ticks) const {
  const std::uint64_t clocks = ticks * prescale_ * clock_.div;
  return anchor_ + (clock_.mul == 1 ? clocks : (clocks + clock_.mul - 1) / clock_.mul);
}

double Timer::period_s() const {
  const double core_ticks = static_cast<double>(law_.period() * prescale_ * clock_.div) / clock_.mul;
  return core_ticks / system().core_hz();
}

// Moves the counter to `position`, keeping the phase of the prescaler.
void Timer::move_to(std::uint64_t position) {
  if (running_) anchor_ = std::max(anchor_, cycle_of(done_));
  start_ = position;
  done_ = 0;
}

std::uint32_t Timer::count() const {
  if (running_ && now() < anchor_) {  // above ARR: on the way to the top of its bits
    const std::uint64_t left = (anchor_ - now()) * clock_.mul / (prescale_ * clock_.div);
    return static_cast<std::uint32_t>((spec_.bits32 ? 0x100000000u : 0x10000u) -
                                      std::max<std::uint64_t>(left, 1));
  }
  return static_cast<std::uint32_t>(law_.count(position()));
}

void Timer::set_count(std::uint32_t count) {
  if (!spec_.bits32) count &= 0xFFFFu;
  if (encoder()) {
    shaft_zero_ = shaft_edges() - count;
    shaft_seen_ = unwrapped();
    return;
  }
  const bool down = law_.falling(position());
  if (running_) anchor_ = std::min(anchor_, now());
  done_ = running_ ? ticks_at(now()) : 0;
  move_to(law_.position(count, down));
  if (count <= law_.arr || law_.way != CounterLaw::Way::kUp || !running_) return;
  // RM0090 does not wrap a counter that is above ARR: it runs to the top of its bits, without an update
  // there.
  const std::uint64_t left = (spec_.bits32 ? 0x100000000u : 0x10000u) - count;
  start_ = 0;
  anchor_ += (left * prescale_ * clock_.div + clock_.mul - 1) / clock_.mul;
}

// Deals with everything that happened since the last time, in order.
void Timer::sync_count() {
  if (running_) {
    std::uint64_t end = ticks_at(now());
    while (done_ < end && running_) {
      const std::uint64_t step = law_.to_boundary(position());
      if (done_ + step > end) {
        mark_matches(end - done_);
        done_ = end;
        break;
      }
      mark_matches(step);
      done_ += step;
      boundary();
      end = ticks_at(now());
      if (!running_ || end < done_ + 2 * law_.period()) continue;
      const bool steady = (value(kCr1) & kUdis) != 0 || !transfer_pending();
      if (steady) skip_periods((end - done_) / law_.period());
    }
    // Counted from here on, so that position() need not divide; exact where ticks are whole cycles.
    if (running_ && clock_.mul == 1 && done_ >= law_.period()) move_to(position());
  }
  look_at_references();
}

// Whole periods in which nothing changes but flags.
void Timer::skip_periods(std::uint64_t whole) {
  const std::uint64_t ends = whole * (law_.way == CounterLaw::Way::kCentre ? 2 : 1);
  mark_matches(law_.period());
  done_ += whole * law_.period();
  if (ends <= repeat_left_) {
    repeat_left_ -= ends;
    return;
  }
  const std::uint64_t every = spec_.advanced ? value(kRcr) + 1u : 1u;
  const std::uint64_t after_first = ends - repeat_left_ - 1;
  repeat_left_ = every - 1 - after_first % every;
  if ((value(kCr1) & kUdis) != 0) return;
  updates_lost_ += after_first / every + (value(kSr) & kUpdate);
  raise(kUpdate);
}

void Timer::boundary() {
  if (repeat_left_ > 0) {
    --repeat_left_;
    return;
  }
  update_event(false);
}

void Timer::update_event(bool by_software) {
  const std::uint32_t cr1 = value(kCr1);
  if ((cr1 & kUdis) != 0) return;
  transfer();
  if (!by_software && (cr1 & kOpm) != 0) {
    move_to(law_.way == CounterLaw::Way::kCentre ? position() : 0);
    value(kCr1) &= ~kCen;
    running_ = false;
    forget_pins();
  }
  if (!by_software && (value(kBdtr) & kAoe) != 0 && !break_high_) {
    value(kBdtr) |= kMoe;
    forget_pins();
  }
  if (!by_software || (cr1 & kUrs) == 0) {
    if (!by_software) updates_lost_ += value(kSr) & kUpdate;
    raise(kUpdate);
    if ((value(kDier) & kUpdateDma) != 0) context_.dma.pulse(dma_update_);
  }
  if (field(value(kCr2), 4, 3) == 2) context_.triggers.fire(trgo_, true);
  outputs_changed();
}

// Preload registers become active.
void Timer::transfer() {
  if ((preloaded_ >> kChannels & 1u) != 0) {
    const std::uint64_t at = law_.count(position());
    const bool down = law_.falling(position());
    const bool turning = law_.way == CounterLaw::Way::kCentre && at == law_.arr;
    move_to(0);
    prescale_ = value(kPsc) + 1u;
    law_.arr = value(kArr);
    if (law_.arr > 0)
      start_ = turning ? law_.arr : law_.way == CounterLaw::Way::kCentre ? law_.position(at, down) : 0;
    forget_pins();
  }
  if (preloaded_ != 0) {
    for (unsigned c = 0; c < kChannels; ++c) {
      if ((preloaded_ >> c & 1u) != 0) ccr_[c] = value(kCcr1 + 4 * c);
    }
    forget_pins(preloaded_);
    preloaded_ = 0;
  }
  repeat_left_ = spec_.advanced ? value(kRcr) : 0;
  if (law_.arr == 0) {
    running_ = false;
    forget_pins();
  }
}

// After CR1, SMCR or ARR: way of counting, running or not.
void Timer::follow_settings() {
  forget_pins();
  const std::uint32_t cr1 = value(kCr1);
  const std::uint32_t count_now = count();
  const bool down = law_.falling(position());
  const auto way = field(cr1, 5, 2) != 0 ? CounterLaw::Way::kCentre
                   : (cr1 & kDir) != 0   ? CounterLaw::Way::kDown
                                         : CounterLaw::Way::kUp;
  const bool above = running_ && now() < anchor_;
  const unsigned slave = field(value(kSmcr), 0, 3) | field(value(kSmcr), 16, 1) << 3;
  const bool gate = slave != 5 || timer_input(field(value(kSmcr), 4, 3) == 6 ? 1 : 0);
  const std::uint64_t arr = (cr1 & kArpe) != 0 ? law_.arr : value(kArr);
  const bool runs = (cr1 & kCen) != 0 && arr > 0 && !encoder() && slave != 7 && gate;
  if (way != law_.way || arr != law_.arr) {
    if (!above) move_to(0);
    law_.way = way;
    law_.arr = arr;
    if (arr > 0 && !above) {
      start_ = law_.position(count_now, down);
      if (count_now > arr) set_count(count_now);
    }
    note_preloads();
  }
  if (runs == running_) return;
  if (running_) move_to(position());
  running_ = runs;
  anchor_ = now();
}

void Timer::raise(std::uint32_t flags) {
  if ((value(kSr) & flags) == flags) return;
  value(kSr) |= flags;
  update_irqs();
}

void Timer::update_irqs() {
  const std::uint32_t on = value(kSr) & value(kDier);
  if (on == asking_) return;
  asking_ = on;
  irq_update_.set((on & kUpdate) != 0);
  irq_compare_.set((on & 0x1Eu) != 0);
  irq_break_.set((on & kBreak) != 0);
  irq_trigger_.set((on & (kTrigger | kCom)) != 0);
}

// Of an encoder without looking at the shaft, which is what wraps the counter and turns its direction.
std::uint32_t Timer::shown(std::uint32_t offset) {
  if (!encoder()) return offset == kSr || offset == kCnt || offset == kCr1 ? load(offset) : value(offset);
  if (offset == kCr1) return (value(kCr1) & ~kDir) | (shaft_falling_ ? kDir : 0u);
  const std::int64_t turns = static_cast<std::int64_t>(law_.arr) + 1;
  return offset == kCnt ? static_cast<std::uint32_t>((unwrapped() % turns + turns) % turns) : value(offset);
}

void Timer::run_events() {
  sync();
  plan();
}

void Timer::clock_changed() {
  sync();
  const ClockRatio ratio = spec_.fast_clock && context_.clocks.state().fast_timers_on
                               ? context_.clocks.state().fast_timers
                               : context_.clocks.timers(spec_.bus);
  if (!(ratio == clock_)) {
    if (running_) move_to(position());
    clock_ = ratio;
  }
  plan();
  outputs_changed();
}

std::uint32_t Timer::load(std::uint32_t offset) {
  if (offset == kSr || offset == kCnt || offset == kCr1) sync();
  switch (offset) {
    case kCr1: {
      const bool down = encoder() ? shaft_falling_ : law_.falling(position());
      return (value(kCr1) & ~kDir) | (down ? kDir : 0u);
    }
    case kCnt:
      return encoder() ? shaft_count() : count();
    case kDmar:
    case kNewDmar: {
      if (offset == kDmar && spec_.new_layout) break;  // CCR6
      const std::uint32_t dcr = value(spec_.new_layout ? kNewDcr : kDcr);
      const std::uint32_t at = 4 * (field(dcr, 0, 5) + burst_);
      burst_ = (burst_ + 1) % (field(dcr, 8, 5) + 1);
      return at <= kBdtr ? load(at) : 0;
    }
    default:
      break;
  }
  if (offset >= kCcr1 && offset < kCcr1 + 16 && captures((offset - kCcr1) / 4)) {
    value(kSr) &= ~(kCompare1 << (offset - kCcr1) / 4);
    update_irqs();
  }
  return value(offset);
}

void Timer::generate(std::uint32_t events) {
  if ((events & kUpdate) != 0) {
    const bool silent = (value(kCr1) & kUdis) != 0;
    if (encoder()) {
      set_count(0);
    } else {
      anchor_ = now();  // the prescaler starts anew
      start_ = done_ = 0;
    }
    if (!silent) update_event(true);
    follow_settings();
    if (field(value(kCr2), 4, 3) == 0) context_.triggers.fire(trgo_, true);
  }
  for (unsigned c = 0; c < kChannels; ++c) {
    if ((events & (kCompare1 << c)) == 0) continue;
    if (captures(c)) {
      capture(c);
    } else {
      raise(kCompare1 << c);
    }
  }
  if ((events & kCom) != 0) commutate();
  if ((events & kTrigger) != 0) trigger_edge();
  if ((events & kBreak) != 0) {
    value(kBdtr) &= ~kMoe;
    forget_pins();
    raise(kBreak);
    outputs_changed();
  }
}

void Timer::store_dma_burst(std::uint32_t written) {
  const std::uint32_t dcr = value(spec_.new_layout ? kNewDcr : kDcr);
  const std::uint32_t at = 4 * (field(dcr, 0, 5) + burst_);
  burst_ = (burst_ + 1) % (field(dcr, 8, 5) + 1);
  if (at < kBdtr) store(at, written, 0xFFFFFFFFu);
}

// A compare value that waits for the next update event changes nothing until then: no need to look at more
// than whether that event has come since the last look.
bool Timer::store_preload(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset < kCcr1 || offset >= kCcr1 + 16 || encoder()) return false;
  const unsigned c = (offset - kCcr1) / 4;
  if (captures(c) || !bit(value(kCcmr1 + 4 * (c / 2)), 3 + 8 * (c % 2))) return false;
  const Cycles at = now();
  const bool waited = transfer_pending();
  // The next update is ahead where it is what next_ says.
  const bool planned = update_alone_ && next_ > at && heard_then_ == context_.triggers.version();
  bool ended = false;
  if (running_ && !(planned && next_ != kNever)) {
    ended = ticks_at(at) >= done_ + law_.to_boundary(position());
    if (ended) sync();
  }
  std::uint32_t& preload = value(offset);
  preload = (preload & ~lanes) | ((spec_.bits32 ? written : written & 0xFFFFu) & lanes);
  preloaded_ = (preloaded_ & ~(1u << c)) | (ccr_[c] != preload ? 1u << c : 0u);
  if (ended || !planned || waited != transfer_pending()) plan();
  return true;
}

void Timer::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (store_preload(offset, written, lanes)) return;
  sync();
  const bool burst_register = offset == (spec_.new_layout ? kNewDmar : kDmar);
  if (burst_register) return store_dma_burst(written);
  switch (offset) {
    case kSr:  // flags are cleared by writing 0
      value(kSr) &= written | ~lanes;
      if (break_high_) value(kSr) |= kBreak;
      update_irqs();
      break;
    case kEgr:
      generate(written);
      break;
    case kCnt:
      set_count((written & lanes) | ((lanes == 0xFFFFFFFFu ? 0u : load(kCnt)) & ~lanes));
      break;
    case kCr1: {
      const bool enabled = (value(kCr1) & kCen) != 0;
      const std::int64_t at = encoder() ? unwrapped() : 0;
      keep(offset, written, lanes);
      if (encoder() && enabled != ((value(kCr1) & kCen) != 0)) shaft_zero_ = shaft_edges() - at;
      follow_settings();
      if (!enabled && (value(kCr1) & kCen) != 0 && field(value(kCr2), 4, 3) == 1)
        context_.triggers.fire(trgo_, true);
      break;
    }
    case kSmcr: {
      const std::uint32_t at = load(kCnt);
      keep(offset, written, lanes);
      note_settings();
      if (encoder()) set_count(at);
      follow_settings();
      break;
    }
    case kArr:
      keep(offset, spec_.bits32 ? written : written & 0xFFFFu, lanes);
      follow_settings();
      break;
    case kDier:
      keep(offset, written, lanes);
      update_irqs();
      break;
    default:
      keep(offset, written, lanes);
      if (offset == kBdtr && spec_.advanced) look_at_break();
      break;
  }
  if (offset == kCr2 || offset == kCcmr1 || offset == kCcmr2 || offset == kDier) note_settings();
  bool acts = offset != kSr && offset != kDier && offset != kCnt;  // on the outputs, at once
  if (acts) forget_pins();
  if (offset >= kCcr1 && offset < kCcr1 + 16) {
    const unsigned c = (offset - kCcr1) / 4;
    if (!spec_.bits32) value(offset) &= 0xFFFFu;
    acts = !captures(c);
    if (acts) ccr_[c] = value(offset);
  }
  if (offset == kCcmr1 || offset == kCcmr2) {
    for (unsigned c = 0; c < kChannels; ++c) {
      if (!captures(c) && !bit(value(kCcmr1 + 4 * (c / 2)), 3 + 8 * (c % 2))) ccr_[c] = value(kCcr1 + 4 * c);
    }
  }
  if (offset != kSr) note_preloads();
  if (offset == kSmcr || offset == kCr2 || offset == kCcmr1 || offset == kCcmr2) listen_to_triggers();
  look_at_references();
  plan();
  if (acts) outputs_changed();
}

}  // namespace omnihil::mcu
