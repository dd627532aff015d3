#include "firmware_iface/mcu/rp2040/io_bank.h"

#include <string>

namespace omnihil::mcu::rp2040 {
namespace {
enum : std::uint32_t { kIntr = 0xF0, kInte = 0x100, kIntf = 0x110, kInts = 0x120, kOthers = 0x130 };
enum : std::uint32_t { kLevelLow = 1, kLevelHigh = 2, kEdgeLow = 4, kEdgeHigh = 8, kEdges = 0xCCCCCCCC };
constexpr int kIrq = 13;
constexpr std::uint32_t kPadReset = 0x56;  // input buffer on, pull-down, Schmitt trigger, 4 mA
constexpr unsigned kPullUp = 3, kInputEnable = 6, kOutputDisable = 7;

const RegisterTable& table() {
  static const RegisterTable rows = [] {
    RegisterTable t;
    for (std::uint32_t pin = 0; pin < kPins; ++pin) {
      const std::string name = "GPIO" + std::to_string(pin);
      t.add(8 * pin, name + "_STATUS", 0, 0);
      t.add(8 * pin + 4, name + "_CTRL", 0x1F, 0x3003331F, 0x30000000);
    }
    for (std::uint32_t i = 0; i < 4; ++i) t.add(kIntr + 4 * i, "INTR" + std::to_string(i), 0, 0);
    std::uint32_t at = kInte;
    for (const char* who : {"PROC0", "PROC1", "DORMANT_WAKE"}) {
      for (const char* what : {"_INTE", "_INTF", "_INTS"}) {
        const bool acts = at < kOthers, read_only = what[4] == 'S';
        for (std::uint32_t i = 0; i < 4; ++i, at += 4) {
          t.add(at, who + std::string(what) + std::to_string(i), 0, read_only ? 0u : 0xFFFFFFFFu,
                acts ? 0u : 0xFFFFFFFFu);
        }
      }
    }
    return t;
  }();
  return rows;
}

const RegisterTable& pad_table() {
  static const RegisterTable rows = [] {
    RegisterTable t;
    t.add(0x00, "VOLTAGE_SELECT", 0, 1);
    for (std::uint32_t pin = 0; pin < kPins; ++pin)
      t.add(4 + 4 * pin, "GPIO" + std::to_string(pin), kPadReset, 0xFF);
    t.add(0x7C, "SWCLK", 0xDA, 0xFF);
    t.add(0x80, "SWD", 0x5A, 0xFF);
    return t;
  }();
  return rows;
}

// An override of two bits: as it is, inverted, 0, 1.
bool overridden(std::uint32_t how, bool level) { return how == 0 ? level : how == 1 ? !level : how == 3; }
}  // namespace

IoBank::IoBank(ChipContext& context)
    : Rp2040Block("IO_BANK0", context.system, table().rows()),
      PinBank(kGp, kPins),
      line_(context.irqs, kIrq) {
  next_event_is(kNever);
  pads_.fill(kPadReset);
  on_level([this](unsigned, unsigned pin, bool) { tell_input(pin); });
  IoBank::reset();
}

void IoBank::reset() {
  Rp2040Block::reset();
  edges_ = {};
  refresh();
  edges_ = {};
  update();
}

void IoBank::set_pad(unsigned pin, std::uint32_t pad) {
  if (pads_[pin] == pad) return;
  pads_[pin] = pad;
  refresh();
}

// What each pin is, from its CTRL and pad.
void IoBank::refresh() {
  plain_ = true;
  of_ = {};
  seen_ = inverted_ = pulled_ = 0;
  for (unsigned pin = 0; pin < kPins; ++pin) {
    const std::uint32_t ctrl = value(8 * pin + 4), mask = 1u << pin;
    function_[pin] = static_cast<std::uint8_t>(ctrl & 31u);
    if (function_[pin] >= kSio && function_[pin] <= kPio1) of_[function_[pin] - kSio] |= mask;
    if ((ctrl & 0x3300u) != 0 || bit(pads_[pin], kOutputDisable)) plain_ = false;
    const std::uint32_t in = field(ctrl, 16, 2);  // as it is, inverted, 0, 1
    if (in < 2 && bit(pads_[pin], kInputEnable)) seen_ |= mask;
    if (in == 1 || in == 3) inverted_ |= mask;
    if (bit(pads_[pin], kPullUp)) pulled_ |= mask;
  }
  apply_outputs();
  modes_changed();
  for (unsigned pin = 0; (inputs() ^ told_) >> pin != 0; ++pin) tell_input(pin);
}

void IoBank::drive_from(Function from, std::uint32_t out, std::uint32_t enable) {
  const unsigned i = static_cast<unsigned>(from) - kSio;
  const bool same = enable_[i] == enable;
  out_[i] = out;
  enable_[i] = enable;
  if (same && plain_) {
    odr_ = (odr_ & ~of_[i]) | (out & of_[i]);
    changed();
  } else {
    apply_outputs();
  }
}

void IoBank::apply_outputs() {
  odr_ = outputs_ = 0;
  modes_ = 0;
  for (unsigned i = 0; i < 3; ++i) {
    odr_ |= out_[i] & of_[i];
    outputs_ |= enable_[i] & of_[i];
  }
  for (unsigned pin = 0; pin < kPins; ++pin) {
    const std::uint32_t ctrl = value(8 * pin + 4), mask = 1u << pin;
    const bool of_block = ((of_[0] | of_[1] | of_[2]) & mask) != 0;
    if (!plain_) {
      // A pin of nobody here may still be forced by both overrides.
      const bool high = overridden(field(ctrl, 8, 2), (odr_ & mask) != 0);
      const bool on =
          overridden(field(ctrl, 12, 2), (outputs_ & mask) != 0) && !bit(pads_[pin], kOutputDisable);
      odr_ = (odr_ & ~mask) | (high ? mask : 0u);
      outputs_ = (outputs_ & ~mask) | (on ? mask : 0u);
    }
    PinMode mode = (outputs_ & mask) != 0 ? PinMode::kOutput : PinMode::kInput;
    if (!of_block && function_[pin] != kNone && mode == PinMode::kInput) mode = PinMode::kAlternate;
    modes_ |= std::uint64_t{static_cast<unsigned>(mode)} << (2 * pin);
  }
  changed();
}

void IoBank::tell_input(unsigned pin) {
  const bool level = bit(inputs(), pin);
  if (level == bit(told_, pin)) return;
  told_ ^= 1u << pin;
  edges_[pin / 8] |= (level ? kEdgeHigh : kEdgeLow) << (4 * (pin % 8));
  update();
  for (const auto& listener : input_listeners_) listener(pin, level);
}

std::uint32_t IoBank::raw(unsigned word) const {
  const std::uint32_t in = inputs() >> (8 * word) & 0xFFu;
  std::uint32_t levels = 0;
  for (unsigned pin = 0; pin < 8; ++pin) {
    if (8 * word + pin < kPins) levels |= (bit(in, pin) ? kLevelHigh : kLevelLow) << (4 * pin);
  }
  return levels | edges_[word];
}

std::uint32_t IoBank::shown_interrupts(unsigned word) const {
  const std::uint32_t enabled = value(kInte + 4 * word);
  return (enabled != 0 ? raw(word) & enabled : 0u) | value(kIntf + 4 * word);
}

void IoBank::update() {
  bool asks = false;
  for (unsigned word = 0; word < kWords && !asks; ++word) asks = shown_interrupts(word) != 0;
  line_.set(asks);
}

std::uint32_t IoBank::load(std::uint32_t offset) {
  if (offset < kIntr) {
    const unsigned pin = offset / 8;
    if (offset % 8 != 0) return value(offset);
    const bool pad = bit(levels(), pin), out = bit(odr_, pin), on = bit(outputs_, pin);
    return (out ? 0x300u : 0u) | (on ? 0x3000u : 0u) | (pad ? 1u << 17 : 0u) |
           (bit(inputs(), pin) ? 1u << 19 : 0u);
  }
  if (offset < kInte) return raw((offset - kIntr) / 4);
  if (offset >= kInts && offset < kOthers) return shown_interrupts((offset - kInts) / 4);
  return value(offset);
}

void IoBank::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset >= kIntr && offset < kInte) {
    edges_[(offset - kIntr) / 4] &= ~(written & kEdges);
  } else {
    const std::uint32_t before = value(offset);
    keep(offset, written, lanes);
    if (offset < kIntr && value(offset) != before) refresh();
  }
  update();
}

Pads::Pads(IoBank& io, ChipContext& context)
    : Rp2040Block("PADS_BANK0", context.system, pad_table().rows()), io_(io) {
  next_event_is(kNever);
}

void Pads::reset() {
  Rp2040Block::reset();
  for (unsigned pin = 0; pin < kPins; ++pin) io_.set_pad(pin, kPadReset);
}

void Pads::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  keep(offset, written, lanes);
  if (offset >= 4 && offset < 4 + 4 * kPins) io_.set_pad(offset / 4 - 1, value(offset));
}

}  // namespace omnihil::mcu::rp2040
