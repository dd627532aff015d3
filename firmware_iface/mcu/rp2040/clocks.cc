#include "firmware_iface/mcu/rp2040/clocks.h"

#include <array>
#include <cmath>
#include <numeric>

namespace omnihil::mcu::rp2040 {
namespace {
// CTRL, DIV and SELECTED of each clock, 12 bytes apart.
enum : std::uint32_t { kRef = 0x30, kSys = 0x3C, kPeri = 0x48, kUsb = 0x54, kAdc = 0x60, kRtc = 0x6C };
enum : std::uint32_t { kFc0Source = 0x94, kFc0Status = 0x98, kFc0Result = 0x9C };
constexpr unsigned kEnable = 11;

const RegisterTable& table() {
  static const RegisterTable rows = [] {
    RegisterTable t;
    constexpr const char* kNames[] = {"CLK_GPOUT0", "CLK_GPOUT1", "CLK_GPOUT2", "CLK_GPOUT3", "CLK_REF",
                                      "CLK_SYS",    "CLK_PERI",   "CLK_USB",    "CLK_ADC",    "CLK_RTC"};
    for (std::uint32_t i = 0; i < std::size(kNames); ++i) {
      const std::string name = kNames[i];
      const std::uint32_t at = 12 * i;
      t.add(at, name + "_CTRL", 0, 0x00131FE3);
      // clk_peri has none; the SDK writes it all the same.
      t.add(at + 4, name + "_DIV", at == kPeri ? 0 : 0x100, at == kPeri ? 0u : 0xFFFFFFFFu);
      t.add(at + 8, name + "_SELECTED", 1, 0);
    }
    t.add(0x78, "CLK_SYS_RESUS_CTRL", 0xFF, 0x000111FF, 0x00000100);
    t.add(0x7C, "CLK_SYS_RESUS_STATUS", 0, 0);
    t.add(0x80, "FC0_REF_KHZ", 0, 0xFFFFF);
    t.add(0x84, "FC0_MIN_KHZ", 0, 0x1FFFFFF);
    t.add(0x88, "FC0_MAX_KHZ", 0x01FFFFFF, 0x1FFFFFF);
    t.add(0x8C, "FC0_DELAY", 1, 7);
    t.add(0x90, "FC0_INTERVAL", 8, 15);
    t.add(kFc0Source, "FC0_SRC", 0, 0xFF);
    t.add(kFc0Status, "FC0_STATUS", 0, 0);
    t.add(kFc0Result, "FC0_RESULT", 0, 0);
    t.add(0xA0, "WAKE_EN0", 0xFFFFFFFF);
    t.add(0xA4, "WAKE_EN1", 0x00007FFF, 0x7FFF);
    t.add(0xA8, "SLEEP_EN0", 0xFFFFFFFF);
    t.add(0xAC, "SLEEP_EN1", 0x00007FFF, 0x7FFF);
    t.add(0xB0, "ENABLED0", 0, 0);
    t.add(0xB4, "ENABLED1", 0, 0);
    t.add(0xB8, "INTR", 0, 0);
    t.add(0xBC, "INTE", 0, 1, 1);
    t.add(0xC0, "INTF", 0, 1, 1);
    t.add(0xC4, "INTS", 0, 0);
    return t;
  }();
  return rows;
}

// AUXSRC of each clock; s, u: the PLLs, r: ring, x: crystal, k: clk_sys, -: a pin.
constexpr std::array<char, 3> kRefSources{'u', '-', '-'};
constexpr std::array<char, 6> kSysSources{'s', 'u', 'r', 'x', '-', '-'};
constexpr std::array<char, 7> kPeriSources{'k', 's', 'u', 'r', 'x', '-', '-'};
constexpr std::array<char, 6> kOtherSources{'u', 's', 'r', 'x', '-', '-'};

ClockRatio ratio(double hz, double core_hz) {
  const auto ticks = static_cast<std::uint64_t>(std::llround(hz));
  const auto cycles = static_cast<std::uint64_t>(std::llround(core_hz));
  const std::uint64_t common = std::gcd(ticks, cycles);
  return {static_cast<std::uint32_t>(ticks / common), static_cast<std::uint32_t>(cycles / common)};
}
}  // namespace

Clocks::Clocks(Xosc& xosc, Rosc& rosc, Pll& sys, Pll& usb, ChipContext& context)
    : Rp2040Block("CLOCKS", context.system, table().rows()),
      context_(context),
      xosc_(xosc),
      rosc_(rosc),
      pll_sys_(sys),
      pll_usb_(usb) {
  next_event_is(kNever);
  for (ClockSource* source : std::initializer_list<ClockSource*>{&xosc, &rosc, &sys, &usb})
    source->on_change([this] { apply(); });
}

void Clocks::reset() {
  Rp2040Block::reset();
  ref_hz_ = sys_hz_ = kRing_hz;
  apply();
}

double Clocks::source_hz(char source) const {
  const double crystal_hz = xosc_.running() ? context_.clocks.hse_hz : 0.0;
  switch (source) {
    case 's':
      return pll_sys_.hz(crystal_hz);
    case 'u':
      return pll_usb_.hz(crystal_hz);
    case 'r':
      return rosc_.running() ? kRing_hz : 0.0;
    case 'x':
      return crystal_hz;
    case 'k':
      return sys_hz_;
    default:
      return 0.0;
  }
}

// DIV: 24 bits of whole and 8 of fraction; a whole part of 0 is 2^16 or more, which nobody means.
double Clocks::divided(double hz, std::uint32_t div) const {
  return div < 0x100 ? hz / 65536.0 : hz * 256.0 / div;
}

double Clocks::auxiliary(std::uint32_t clock, std::span<const char> sources) const {
  const std::uint32_t which = field(value(clock), 5, 3);
  return which < sources.size() ? source_hz(sources[which]) : 0.0;
}

double Clocks::ref_hz() const {
  const std::uint32_t source = value(kRef) & 3u;
  const double hz = source == 0   ? source_hz('r')
                    : source == 1 ? auxiliary(kRef, kRefSources)
                                  : source_hz('x');
  return divided(hz, value(kRef + 4));
}

double Clocks::sys_hz() const {
  const double hz = bit(value(kSys), 0) ? auxiliary(kSys, kSysSources) : ref_hz_;
  return divided(hz, value(kSys + 4));
}

void Clocks::apply() {
  constexpr double kSlowest_hz = 1e3;
  const double ref = ref_hz();
  if (ref >= kSlowest_hz)
    ref_hz_ = ref;
  else
    system().report_unmodelled(name(), "clk_ref is to come from a source that is off; it stays");
  const double sys = sys_hz();
  if (sys >= kSlowest_hz)
    sys_hz_ = sys;
  else
    system().report_unmodelled(name(), "clk_sys is to come from a source that is off; it stays");
  ClockState state;
  state.sysclk_hz = state.hclk_hz = sys_hz_;
  const auto set = [&state, this](Bus which, bool on, double hz) {
    if (!on || hz < kSlowest_hz) {
      state.off |= 1u << static_cast<unsigned>(which);
    } else {
      state.of(which) = ratio(hz, sys_hz_);
    }
  };
  set(Bus::kReference, true, ref_hz_);
  set(Bus::kPeripheral, bit(value(kPeri), kEnable), auxiliary(kPeri, kPeriSources));
  set(Bus::kAdc, bit(value(kAdc), kEnable), divided(auxiliary(kAdc, kOtherSources), value(kAdc + 4)));
  context_.clocks.set(state);
}

// What the frequency counter sees of the clock numbered as FC0_SRC numbers them (§2.15.7).
double Clocks::counted_hz(std::uint32_t source) const {
  switch (source) {
    case 1:
    case 2:
      return source_hz(source == 1 ? 's' : 'u');
    case 3:
    case 4:
      return source_hz('r');
    case 5:
      return source_hz('x');
    case 8:
      return ref_hz_;
    case 9:
      return sys_hz_;
    case 10:
      return bit(value(kPeri), kEnable) ? auxiliary(kPeri, kPeriSources) : 0.0;
    case 11:
    case 12:
    case 13: {
      const std::uint32_t clock = kUsb + 12 * (source - 11);
      return bit(value(clock), kEnable) ? divided(auxiliary(clock, kOtherSources), value(clock + 4)) : 0.0;
    }
    default:
      return 0.0;
  }
}

std::uint32_t Clocks::load(std::uint32_t offset) {
  switch (offset) {
    case kRef + 8:
      return 1u << (value(kRef) & 3u);
    case kSys + 8:
      return 1u << (value(kSys) & 1u);
    case kFc0Status:
      return value(kFc0Source) != 0 ? 1u << 4 : 0u;  // DONE
    case kFc0Result:
      return static_cast<std::uint32_t>(std::llround(counted_hz(value(kFc0Source)) * 32e-3));
    case 0xB0:
      return value(0xA0);
    case 0xB4:
      return value(0xA4);
    default:
      return value(offset);
  }
}

void Clocks::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  const std::uint32_t before = value(offset);
  keep(offset, written, lanes);
  if (offset >= kRef && offset < 0x78 && value(offset) != before) apply();
}

}  // namespace omnihil::mcu::rp2040
