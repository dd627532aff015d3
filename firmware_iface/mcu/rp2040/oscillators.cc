#include "firmware_iface/mcu/rp2040/oscillators.h"

namespace omnihil::mcu::rp2040 {
namespace {
constexpr std::uint32_t kCtrl = 0x00, kEnable = 0xFAB, kDisable = 0xD1E;  // words of CTRL.ENABLE
constexpr std::uint32_t kStable = 1u << 31, kEnabled = 1u << 12;

constexpr RegisterInfo kXosc[] = {{kCtrl, "CTRL", 0, 0x00FFFFFF},
                                  {0x04, "STATUS", 0, 0},
                                  {0x08, "DORMANT", 0, 0xFFFFFFFF, 0xFFFFFFFF},
                                  {0x0C, "STARTUP", 0, 0x00103FFF},
                                  {0x1C, "COUNT", 0, 0}};
constexpr RegisterInfo kRosc[] = {{kCtrl, "CTRL", 0x00000AA0, 0x00FFFFFF},
                                  {0x04, "FREQA", 0, 0xFFFF7777, 0x00007777},
                                  {0x08, "FREQB", 0, 0xFFFF7777, 0x00007777},
                                  {0x0C, "DORMANT", 0, 0xFFFFFFFF, 0xFFFFFFFF},
                                  {0x10, "DIV", 0x00000AB0, 0x0FFF},
                                  {0x14, "PHASE", 0x00000008, 0x0FFF},
                                  {0x18, "STATUS", 0, 0},
                                  {0x1C, "RANDOMBIT", 1, 0},
                                  {0x20, "COUNT", 0, 0xFF}};
enum : std::uint16_t { kCs = 0x00, kPwr = 0x04, kFbdiv = 0x08, kPrim = 0x0C };
constexpr RegisterInfo kPll[] = {{kCs, "CS", 0x00000001, 0x0000013F},
                                 {kPwr, "PWR", 0x0000002D, 0x0000002D},
                                 {kFbdiv, "FBDIV_INT", 0, 0x00000FFF},
                                 {kPrim, "PRIM", 0x00077000, 0x00077000}};
}  // namespace

Xosc::Xosc(ChipContext& context) : ClockSource("XOSC", context.system, kXosc) { next_event_is(kNever); }
bool Xosc::running() const { return field(value(kCtrl), 12, 12) == kEnable; }
std::uint32_t Xosc::load(std::uint32_t offset) {
  if (offset == 0x04) return running() ? kStable | kEnabled : 0u;
  return value(offset);
}
void Xosc::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  keep(offset, written, lanes);
  if (offset == kCtrl) changed();
}

Rosc::Rosc(ChipContext& context) : ClockSource("ROSC", context.system, kRosc) { next_event_is(kNever); }
bool Rosc::running() const { return field(value(kCtrl), 12, 12) != kDisable; }
std::uint32_t Rosc::load(std::uint32_t offset) {
  if (offset == 0x1C) {  // a bit of a xorshift, the same in every run
    noise_ ^= noise_ << 13, noise_ ^= noise_ >> 17, noise_ ^= noise_ << 5;
  }
  return shown(offset);
}
std::uint32_t Rosc::shown(std::uint32_t offset) {
  if (offset == 0x18) return running() ? kStable | 1u << 16 | kEnabled : 0u;
  return offset == 0x1C ? noise_ & 1u : value(offset);
}
void Rosc::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  keep(offset, written, lanes);
  if (offset == kCtrl) changed();
}

Pll::Pll(std::string name, ChipContext& context) : ClockSource(std::move(name), context.system, kPll) {
  next_event_is(kNever);
}
double Pll::hz(double crystal_hz) const {
  constexpr std::uint32_t kDown = 1u << 5 | 1u << 3 | 1u << 0;  // VCO, post dividers, all of it
  if (bit(value(kCs), 8)) return crystal_hz;                    // bypass
  const std::uint32_t reference = field(value(kCs), 0, 6), first = field(value(kPrim), 16, 3),
                      second = field(value(kPrim), 12, 3);
  if ((value(kPwr) & kDown) != 0 || reference == 0 || first == 0 || second == 0) return 0.0;
  return crystal_hz / reference * value(kFbdiv) / (first * second);
}
std::uint32_t Pll::load(std::uint32_t offset) {
  constexpr std::uint32_t kLock = 1u << 31;
  const bool locked = (value(kPwr) & (1u << 5 | 1u)) == 0 && value(kFbdiv) != 0;
  return value(offset) | (offset == kCs && locked ? kLock : 0u);
}
void Pll::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  keep(offset, written, lanes);
  changed();
}

}  // namespace omnihil::mcu::rp2040
