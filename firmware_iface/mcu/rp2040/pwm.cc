#include "firmware_iface/mcu/rp2040/pwm.h"

#include <algorithm>
#include <string>

namespace omnihil::mcu::rp2040 {
namespace {
constexpr std::uint32_t kSliceBytes = 0x14, kEn = 0xA0, kIntr = 0xA4, kInte = 0xA8, kIntf = 0xAC,
                        kInts = 0xB0;
constexpr int kIrqWrap = 4;
constexpr std::uint32_t kAdvance = 1u << 7, kRetard = 1u << 6;

const RegisterTable& table() {
  static const RegisterTable rows = [] {
    RegisterTable t;
    for (std::uint32_t i = 0; i < kSlices; ++i) {
      const std::string name = "CH" + std::to_string(i);
      const std::uint32_t at = kSliceBytes * i;
      t.add(at + PwmSlice::kCsr, name + "_CSR", 0, 0xFF);
      t.add(at + PwmSlice::kDiv, name + "_DIV", 0x10, 0xFFF);
      t.add(at + PwmSlice::kCtr, name + "_CTR", 0, 0xFFFF);
      t.add(at + PwmSlice::kCc, name + "_CC");
      t.add(at + PwmSlice::kTop, name + "_TOP", 0xFFFF, 0xFFFF);
    }
    t.add(kEn, "EN", 0, 0xFF);
    t.add(kIntr, "INTR", 0, 0);
    t.add(kInte, "INTE", 0, 0xFF);
    t.add(kIntf, "INTF", 0, 0xFF);
    t.add(kInts, "INTS", 0, 0);
    return t;
  }();
  return rows;
}
}  // namespace

PwmSlice::PwmSlice(unsigned number, IoBank& io, ChipContext& context)
    : Peripheral("PWM" + std::to_string(number)), number_(number), io_(io), system_(context.system) {
  next_event_is(next_);
  io.on_modes([this] {
    const TimerPin before[] = {pin(0, false), pin(1, false)};
    forget_pins();
    if (!(before[0] == pin(0, false)) || !(before[1] == pin(1, false))) outputs_changed();
    b_changed();
  });
  io.on_input([this](unsigned gpio, bool) {
    if (gpio % 16 == 2 * number_ + 1) b_changed();
  });
}

// As an input: either of its pins that is given to it and high.
bool PwmSlice::find_b() const {
  const unsigned gpio = 2 * number_ + 1;
  const auto high = [this](unsigned at) {
    return at < kPins && io_.function(at) == IoBank::kPwm && bit(io_.inputs(), at);
  };
  return high(gpio) || high(gpio + 16);
}

void PwmSlice::reset() {
  advance();
  csr_ = 0, div_ = 0x10;
  top_ = next_top_ = 0xFFFF;
  cc_ = next_cc_ = {};
  position_ = part_ = edges_ = 0;
  since_ = system_.now();
  heard_ = false;
  b_ = find_b();
  forget_pins();
  plan();
  outputs_changed();
}

// The whole part of DIV is 1 to 256, 0 being the latter.
std::uint32_t PwmSlice::step() const {
  const std::uint32_t whole = div_ >> 4 & 0xFFu;
  return (whole == 0 ? 256u : whole) << 4 | (div_ & 15u);
}

bool PwmSlice::counts() const { return enabled() && (mode() == kFree || (mode() == kGated && b_)); }

std::uint32_t PwmSlice::counter() const {
  const std::uint64_t p = position_, up = std::uint64_t{top_} + 1;
  return static_cast<std::uint32_t>(p < up ? p : 2 * up - 1 - p);
}

void PwmSlice::advance() {
  const Cycles now = system_.now(), passed = now - since_;
  since_ = now;  // before a wrap is told: DMA may write to the slice
  if (!counts() || passed == 0) return;
  const std::uint64_t sixteenths = 16 * passed + part_;
  part_ = static_cast<std::uint32_t>(sixteenths % step());
  count(sixteenths / step());
}

void PwmSlice::count(std::uint64_t ticks) {
  while (ticks > 0) {
    const std::uint64_t left = period() > position_ ? period() - position_ : 1;
    if (ticks < left) {
      position_ += ticks;
      return;
    }
    ticks -= left;
    position_ = 0;
    wrapped();
    if (top_ == next_top_ && cc_ == next_cc_) ticks %= period();  // the others are like this one
  }
}

void PwmSlice::wrapped() {
  transfer();
  if (on_wrap_) on_wrap_();
}

void PwmSlice::transfer() {
  if (top_ == next_top_ && cc_ == next_cc_) return;
  top_ = next_top_;
  cc_ = next_cc_;
  forget_pins();
  outputs_changed();
}

void PwmSlice::plan() {
  const bool coming = top_ != next_top_ || cc_ != next_cc_;
  next_ = kNever;
  if (!counts() || !(heard_ || coming)) return;
  const std::uint64_t left = (period() > position_ ? period() - position_ : 1) * step();
  next_ = since_ + (left - std::min<std::uint64_t>(part_, left) + 15) / 16;
}

void PwmSlice::moved(Cycles before) {
  if (next_ != before) system_.event_moved(&next_, before);
}

void PwmSlice::run_events() {
  if (next_ > system_.now()) return;
  advance();
  plan();
}

void PwmSlice::hear_wraps(bool on) {
  if (heard_ == on) return;
  const Cycles before = next_;
  advance();
  heard_ = on;
  plan();
  moved(before);
}

void PwmSlice::b_changed() {
  const bool level = find_b();
  if (level == b_) return;
  const Cycles before = next_;
  advance();
  b_ = level;
  if (mode() == kGated) forget_pins();
  if (enabled() && ((mode() == kRising && level) || (mode() == kFalling && !level))) {
    edges_ += 16;
    if (edges_ >= step()) edges_ -= step(), count(1);
  }
  plan();
  moved(before);
}

void PwmSlice::outputs_changed() {
  if (listeners_.empty()) return;
  const std::int64_t now_ns = system_.to_ns(system_.now());
  for (const auto& listener : listeners_) listener(now_ns);
}

TimerPin PwmSlice::find_pin(unsigned channel, bool complement) const {
  const unsigned gpio = 2 * number_ + channel;
  const auto given = [this](unsigned to) { return to < kPins && io_.function(to) == IoBank::kPwm; };
  const bool input = channel == 1 && mode() != kFree;
  TimerPin is;
  if (!complement && !input && (given(gpio) || given(gpio + 16))) {
    const bool inverted = (csr_ >> (2 + channel) & 1u) != 0;
    const double high = std::min(1.0, static_cast<double>(cc_[channel]) / (static_cast<double>(top_) + 1.0));
    const double share = counts() || mode() > kGated ? high : counter() < cc_[channel] ? 1.0 : 0.0;
    is.drive = enabled() ? TimerPin::Drive::kPwm : TimerPin::Drive::kSteady;
    is.high_ratio = inverted ? 1.0 - share : share;
  }
  pins_[2 * channel] = is;
  pins_known_ |= complement ? 0u : 1u << 2 * channel;
  return is;
}

bool PwmSlice::level(unsigned channel, bool complement) const {
  const TimerPin is = pin(channel, complement);
  if (is.drive != TimerPin::Drive::kPwm) return is.high_ratio > 0.5;
  return (counter() < cc_[channel]) != ((csr_ >> (2 + channel) & 1u) != 0);
}

double PwmSlice::period_s() const {
  return static_cast<double>(period()) * step() / 16.0 / system_.core_hz();
}

std::uint32_t PwmSlice::read(std::uint32_t offset, unsigned) {
  switch (offset) {
    case kCsr:
      return csr_;
    case kDiv:
      return div_;
    case kCtr:
      return counter();
    case kCc:
      return next_cc_[0] | next_cc_[1] << 16;
    default:
      return next_top_;
  }
}

void PwmSlice::write(std::uint32_t offset, unsigned, std::uint32_t value) {
  const Cycles before = next_;
  advance();
  if (offset == kCsr) {
    const bool was = enabled();
    csr_ = value & 0x3Fu;
    if ((value & kAdvance) != 0) count(1);
    if ((value & kRetard) != 0 && position_ > 0) --position_;
    if (!was) part_ = edges_ = 0;
    forget_pins();
  } else if (offset == kDiv) {
    div_ = value & 0xFFFu;
    part_ = edges_ = 0;
  } else if (offset == kCtr) {
    position_ = std::min(value & 0xFFFFu, top_);
    part_ = 0;
    forget_pins();
  } else if (offset == kCc) {
    next_cc_ = {value & 0xFFFFu, value >> 16};
  } else {
    next_top_ = value & 0xFFFFu;
  }
  if (!enabled()) {
    transfer();
    position_ = std::min<std::uint64_t>(position_, period() - 1);
  }
  plan();
  moved(before);
  if (offset == kCsr || offset == kCtr) outputs_changed();
}

Pwm::Pwm(std::vector<PwmSlice*> slices, ChipContext& context)
    : Rp2040Block("PWM", context.system, table().rows()),
      context_(context),
      slices_(std::move(slices)),
      line_(context.irqs, kIrqWrap) {
  next_event_is(kNever);
  for (unsigned i = 0; i < kSlices; ++i) {
    requests_[i] = context.dma.line("PWM_WRAP" + std::to_string(i));
    slices_[i]->on_wrap([this, i] { wrapped(i); });
  }
}

void Pwm::reset() {
  for (PwmSlice* slice : slices_) slice->reset();
  Rp2040Block::reset();
  interrupts_ = {};
  wanted_ = 0;
  update();
}

void Pwm::hear() {
  for (unsigned i = 0; i < kSlices; ++i) slices_[i]->hear_wraps(bit(interrupts_.enabled | wanted_, i));
}

void Pwm::want_wraps(unsigned slice, bool wanted) {
  wanted_ = (wanted_ & ~(1u << slice)) | (wanted ? 1u << slice : 0u);
  hear();
}

void Pwm::look() {
  for (PwmSlice* slice : slices_) slice->advance();
}

void Pwm::wrapped(unsigned slice) {
  if (bit(interrupts_.enabled & interrupts_.raw, slice)) slices_[slice]->note_lost();
  interrupts_.raw |= 1u << slice;
  context_.dma.pulse(requests_[slice]);
  update();
}

void Pwm::update() { line_.set(interrupts_.shown() != 0); }

std::uint32_t Pwm::load(std::uint32_t offset) {
  look();
  return shown(offset);
}

std::uint32_t Pwm::shown(std::uint32_t offset) {
  if (offset < kEn) return slices_[offset / kSliceBytes]->read(offset % kSliceBytes, 4);
  switch (offset) {
    case kEn: {
      std::uint32_t on = 0;
      for (unsigned i = 0; i < kSlices; ++i) on |= slices_[i]->enabled() ? 1u << i : 0u;
      return on;
    }
    case kIntr:
      return interrupts_.raw;
    case kInte:
      return interrupts_.enabled;
    case kIntf:
      return interrupts_.forced;
    default:
      return interrupts_.shown();
  }
}

void Pwm::store(std::uint32_t offset, std::uint32_t written, std::uint32_t) {
  look();
  if (offset < kEn) {
    slices_[offset / kSliceBytes]->write(offset % kSliceBytes, 4, written);
  } else if (offset == kEn) {
    for (unsigned i = 0; i < kSlices; ++i) {
      const std::uint32_t csr = slices_[i]->read(PwmSlice::kCsr, 4);
      slices_[i]->write(PwmSlice::kCsr, 4, (csr & ~1u) | (written >> i & 1u));
    }
  } else if (offset == kIntr) {
    interrupts_.raw &= ~written;
  } else if (offset == kInte) {
    interrupts_.enabled = written & 0xFFu;
    hear();
  } else if (offset == kIntf) {
    interrupts_.forced = written & 0xFFu;
  }
  update();
}

}  // namespace omnihil::mcu::rp2040
