#include "firmware_iface/mcu/stm32/adc/adc_v2.h"

#include <bit>
#include <utility>

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kIsr = 0x00,
  kIer = 0x04,
  kCr = 0x08,
  kCfgr = 0x0C,
  kCfgr2 = 0x10,
  kSmpr1 = 0x14,
  kSmpr2 = 0x18,
  kChselr = 0x28,
  kSqr1 = 0x30,
  kDr = 0x40,
  kJsqr = 0x4C,
  kJdr1 = 0x80
};
constexpr std::uint32_t kAdrdy = 1, kEosmp = 2, kEoc = 4, kEos = 8, kOvr = 16, kJeoc = 32, kJeos = 64;
constexpr std::uint32_t kEocal = 1u << 11,
                        kCcrdy = 1u << 13;  // G0: calibrated; the choice of channels has come through
constexpr std::uint32_t kAden = 1, kAddis = 2, kAdstart = 4, kJadstart = 8, kAdstp = 16, kJadstp = 32,
                        kAdcal = 1u << 31;

constexpr RegisterInfo kV2[] = {{kIsr, "ISR", 0, 0},
                                {kIer, "IER", 0, 0x7FF, 0x780},
                                {kCr, "CR", 0x20000000, 0x70000000},
                                {kCfgr, "CFGR", 0, 0xFFFFFFFF, 0x01C04000},
                                {kCfgr2, "CFGR2", 0, 0xFFFFFFFF, 0x000001FF},
                                {kSmpr1, "SMPR1"},
                                {kSmpr2, "SMPR2"},
                                {0x20, "TR1", 0x0FFF0000},
                                {0x24, "TR2", 0x00FF0000},
                                {0x28, "TR3", 0x00FF0000},
                                {kSqr1, "SQR1"},
                                {0x34, "SQR2"},
                                {0x38, "SQR3"},
                                {0x3C, "SQR4"},
                                {kDr, "DR", 0, 0},
                                {kJsqr, "JSQR"},
                                {0x60, "OFR1", 0, 0xFFFFFFFF, 0x80000000},
                                {0x64, "OFR2", 0, 0xFFFFFFFF, 0x80000000},
                                {0x68, "OFR3", 0, 0xFFFFFFFF, 0x80000000},
                                {0x6C, "OFR4", 0, 0xFFFFFFFF, 0x80000000},
                                {kJdr1, "JDR1", 0, 0},
                                {0x84, "JDR2", 0, 0},
                                {0x88, "JDR3", 0, 0},
                                {0x8C, "JDR4", 0, 0},
                                {0xA0, "AWD2CR", 0, 0x7FFFF, 0x7FFFF},
                                {0xA4, "AWD3CR", 0, 0x7FFFF, 0x7FFFF},
                                {0xB0, "DIFSEL", 0, 0x7FFFE, 0x7FFFE},
                                {0xB4, "CALFACT", 0x00400040, 0x007F007F},
                                {0xC0, "GCOMP", 0, 0x3FFF, 0x3FFF}};
// Not followed: AUTDLY, JQM, watchdogs, oversampling, shifts, offsets, differential inputs, linearity's words.
constexpr RegisterInfo kH7[] = {{kIsr, "ISR", 0, 0},
                                {kIer, "IER", 0, 0x7FF, 0x780},
                                {kCr, "CR", 0x20000000, 0x7FC10300},
                                {kCfgr, "CFGR", 0x80000000, 0xFFFFFFFF, 0x01E04000},
                                {kCfgr2, "CFGR2", 0, 0xFFFFFFFF, 0xF3FF07E3},
                                {kSmpr1, "SMPR1"},
                                {kSmpr2, "SMPR2"},
                                {0x1C, "PCSEL", 0, 0xFFFFF},
                                {0x20, "LTR1"},
                                {0x24, "HTR1", 0x03FFFFFF},
                                {kSqr1, "SQR1"},
                                {0x34, "SQR2"},
                                {0x38, "SQR3"},
                                {0x3C, "SQR4"},
                                {kDr, "DR", 0, 0},
                                {kJsqr, "JSQR"},
                                {0x60, "OFR1", 0, 0xFFFFFFFF, 0x83FFFFFF},
                                {0x64, "OFR2", 0, 0xFFFFFFFF, 0x83FFFFFF},
                                {0x68, "OFR3", 0, 0xFFFFFFFF, 0x83FFFFFF},
                                {0x6C, "OFR4", 0, 0xFFFFFFFF, 0x83FFFFFF},
                                {kJdr1, "JDR1", 0, 0},
                                {0x84, "JDR2", 0, 0},
                                {0x88, "JDR3", 0, 0},
                                {0x8C, "JDR4", 0, 0},
                                {0xA0, "AWD2CR", 0, 0xFFFFF, 0xFFFFF},
                                {0xA4, "AWD3CR", 0, 0xFFFFF, 0xFFFFF},
                                {0xB0, "LTR2"},
                                {0xB4, "HTR2", 0x03FFFFFF},
                                {0xB8, "LTR3"},
                                {0xBC, "HTR3", 0x03FFFFFF},
                                {0xC0, "DIFSEL", 0, 0xFFFFF, 0xFFFFF},
                                {0xC4, "CALFACT", 0, 0x07FF07FF},
                                {0xC8, "CALFACT2", 0, 0x3FFFFFFF}};
constexpr RegisterInfo kF0[] = {{kIsr, "ISR", 0, 0},
                                {kIer, "IER", 0, 0x9F, 0x80},
                                {kCr, "CR", 0, 0},
                                {kCfgr, "CFGR1", 0, 0x7CC1FDFF, 0x00C0C000},
                                {kCfgr2, "CFGR2", 0, 0xC0000000},
                                {kSmpr1, "SMPR", 0, 7},
                                {0x20, "TR", 0x0FFF0000},
                                {kChselr, "CHSELR", 0, 0x7FFFF},
                                {kDr, "DR", 0, 0}};
// Not followed: WAIT, AUTOFF, watchdogs, oversampling.
constexpr RegisterInfo kG0[] = {{kIsr, "ISR", 0, 0},
                                {kIer, "IER", 0, 0x2B9F, 0x0380},
                                {kCr, "CR", 0, 0x10000000},
                                {kCfgr, "CFGR1", 0, 0x7CE1FDFF, 0x00C0C000},
                                {kCfgr2, "CFGR2", 0, 0xE00003FD, 0x000003FD},
                                {kSmpr1, "SMPR", 0, 0x07FFFF77},
                                {0x20, "AWD1TR", 0x0FFF0000},
                                {0x24, "AWD2TR", 0x0FFF0000},
                                {kChselr, "CHSELR"},
                                {0x2C, "AWD3TR", 0x0FFF0000},
                                {kDr, "DR", 0, 0},
                                {0xA0, "AWD2CR", 0, 0x7FFFF, 0x7FFFF},
                                {0xA4, "AWD3CR", 0, 0x7FFFF, 0x7FFFF},
                                {0xB4, "CALFACT", 0x40, 0x7F}};
constexpr RegisterInfo kCommon[] = {{0x00, "CSR", 0, 0}, {0x08, "CCR", 0, 0x01FFEF1F}, {0x0C, "CDR", 0, 0}};

std::span<const RegisterInfo> rows_of(AdcFamily family) {
  if (family == AdcFamily::kF0) return kF0;
  if (family == AdcFamily::kG0) return kG0;
  return family == AdcFamily::kH7 ? std::span<const RegisterInfo>(kH7) : kV2;
}
}  // namespace

AdcV2::AdcV2(const std::string& name, AdcFamily family, int irq, const AdcTriggers& triggers,
             ChipContext& context)
    : Adc(name, rows_of(family), triggers, context),
      family_(family),
      irq_(context.irqs, irq),
      dma_(context.dma.line(name)) {}

void AdcV2::reset() {
  Adc::reset();
  count_selected();
  update();
}

void AdcV2::count_selected() { selected_ = static_cast<unsigned>(std::popcount(value(kChselr))); }

unsigned AdcV2::length(Group group) const {
  if (places_chosen() && group == Group::kRegular) {  // up to the first place that names no channel
    unsigned places = 0;
    while (places < 8 && field(value(kChselr), 4 * places, 4) != 15) ++places;
    return places;
  }
  if (regular_alone()) return group == Group::kRegular ? selected_ : 0;
  return group == Group::kInjected ? field(value(kJsqr), 0, 2) + 1 : field(value(kSqr1), 0, 4) + 1;
}

unsigned AdcV2::channel(Group group, unsigned place) const {
  if (places_chosen()) return field(value(kChselr), 4 * place, 4);
  if (regular_alone()) {  // the selected ones, upwards or (SCANDIR) downwards
    const unsigned n = bit(value(kCfgr), 2) ? length(group) - 1 - place : place;
    std::uint32_t left = value(kChselr);
    for (unsigned i = 0; i < n; ++i) left &= left - 1;
    return static_cast<unsigned>(std::countr_zero(left | 1u << 31)) % 32;
  }
  if (group == Group::kInjected) return field(value(kJsqr), (old_fields() ? 8 : 9) + 6 * place, 5);
  return field(value(kSqr1 + 4 * ((place + 1) / 5)), 6 * ((place + 1) % 5), 5);
}

double AdcV2::sample_clocks(unsigned channel) const {
  constexpr double kF0Clocks[] = {1.5, 7.5, 13.5, 28.5, 41.5, 55.5, 71.5, 239.5};
  constexpr double kF3Clocks[] = {1.5, 2.5, 4.5, 7.5, 19.5, 61.5, 181.5, 601.5};
  constexpr double kG4Clocks[] = {2.5, 6.5, 12.5, 24.5, 47.5, 92.5, 247.5, 640.5};
  constexpr double kG0Clocks[] = {1.5, 3.5, 7.5, 12.5, 19.5, 39.5, 79.5, 160.5};
  constexpr double kH7Clocks[] = {1.5, 2.5, 8.5, 16.5, 32.5, 64.5, 387.5, 810.5};
  if (family_ == AdcFamily::kF0) return kF0Clocks[value(kSmpr1) & 7u];
  if (family_ == AdcFamily::kG0)  // one of two, by SMPSEL
    return kG0Clocks[field(value(kSmpr1), bit(value(kSmpr1), 8 + channel) ? 4 : 0, 3)];
  const unsigned code =
      channel < 10 ? field(value(kSmpr1), 3 * channel, 3) : field(value(kSmpr2), 3 * (channel % 10), 3);
  if (family_ == AdcFamily::kH7) return kH7Clocks[code];
  return family_ == AdcFamily::kF3 ? kF3Clocks[code] : kG4Clocks[code];
}

double AdcV2::clock_hz() const {
  const ClockTree& clocks = context().clocks;
  if (family_ == AdcFamily::kF0) {
    const unsigned mode = field(value(kCfgr2), 30, 2);
    return mode == 0 ? 14e6 : clocks.bus_hz(Bus::kApb1) / (mode == 1 ? 2 : 4);  // 0: its own HSI14
  }
  const bool own_mode = family_ == AdcFamily::kG0;
  const unsigned mode = own_mode ? field(value(kCfgr2), 30, 2) : field(ccr_, 16, 2);
  constexpr double kAsync[] = {1, 2, 4, 6, 8, 10, 12, 16, 32, 64, 128, 256, 256, 256, 256, 256};
  const double halved = family_ == AdcFamily::kH7 ? 2.0 : 1.0;
  if (mode == 0)
    return clocks.bus_hz(Bus::kAdc) / (family_ == AdcFamily::kF3 ? 1.0 : kAsync[field(ccr_, 18, 4)]) / halved;
  if (own_mode) return clocks.bus_hz(Bus::kApb1) / (mode == 3 ? 1 : 2 * mode);
  return clocks.bus_hz(Bus::kAhb) / (mode == 1 ? 1 : mode == 2 ? 2 : 4) / halved;
}

unsigned AdcV2::bits() const {
  if (family_ != AdcFamily::kH7) return 12 - 2 * field(value(kCfgr), 3, 2);
  constexpr unsigned kBits[] = {16, 14, 12, 10, 8, 14, 12, 8};
  return kBits[field(value(kCfgr), 2, 3)];
}

bool AdcV2::left_aligned() const {
  return family_ != AdcFamily::kH7 && bit(value(kCfgr), family_ == AdcFamily::kG4 ? 15 : 5);
}

std::pair<int, unsigned> AdcV2::trigger(Group group) const {
  const std::uint32_t cfgr = value(kCfgr), jsqr = value(kJsqr);
  switch (family_) {
    case AdcFamily::kF0:
    case AdcFamily::kG0:
      if (group == Group::kInjected) return {-1, 0};
      return {static_cast<int>(field(cfgr, 6, 3)), field(cfgr, 10, 2)};
    case AdcFamily::kF3:
    case AdcFamily::kL4:
      if (group == Group::kInjected) return {static_cast<int>(field(jsqr, 2, 4)), field(jsqr, 6, 2)};
      return {static_cast<int>(field(cfgr, 6, 4)), field(cfgr, 10, 2)};
    case AdcFamily::kG4:
    case AdcFamily::kH7:
      break;
  }
  if (group == Group::kInjected) return {static_cast<int>(field(jsqr, 2, 5)), field(jsqr, 7, 2)};
  return {static_cast<int>(field(cfgr, 5, 5)), field(cfgr, 10, 2)};
}

bool AdcV2::armed(Group group) const {
  return (value(kCr) & (group == Group::kRegular ? kAdstart : kJadstart)) != 0;
}

void AdcV2::result(Group group, unsigned place, std::uint32_t code, bool last) {
  std::uint32_t& isr = value(kIsr);
  if (group == Group::kInjected) {
    value(kJdr1 + 4 * place) = code;
    isr |= kJeoc | (last ? kJeos : 0u);
    if (last && trigger(group).second == 0 && !injected_follow()) value(kCr) &= ~kJadstart;
    return update();
  }
  const bool dma = bit(value(kCfgr), 0);
  const bool overrun = (isr & kEoc) != 0;
  if (overrun) isr |= kOvr;
  if (!overrun || bit(value(kCfgr), 12)) value(kDr) = code;
  isr |= kEosmp | kEoc | (last ? kEos : 0u);
  if (trigger(group).second == 0 && !continues() && (last || one_per_trigger())) value(kCr) &= ~kAdstart;
  update();
  if (dma) context().dma.pulse(dma_);
}

void AdcV2::update() {
  const std::uint32_t all = family_ == AdcFamily::kG0 ? 0x7Fu | kEocal | kCcrdy : 0x7Fu;
  irq_.set((value(kIsr) & value(kIer) & all) != 0);
}

std::uint32_t AdcV2::load(std::uint32_t offset) {
  if (offset == kDr) data_was_read();
  return shown(offset);
}

std::uint32_t AdcV2::shown(std::uint32_t offset) {  // H7: LDORDY, the regulator is ready
  constexpr std::uint32_t kLdordy = 1u << 12;
  const bool ready = family_ == AdcFamily::kH7 && offset == kIsr && bit(value(kCr), 28);
  return value(offset) | (ready ? kLdordy : 0u);
}

void AdcV2::data_was_read() {
  value(kIsr) &= ~kEoc;
  update();
}

// CR: bits are set by software and cleared by the hardware.
void AdcV2::control(std::uint32_t written) {
  std::uint32_t& cr = value(kCr);
  // voltage regulator, deep power down, kind of calibration; H7 also boost and linearity
  const std::uint32_t kept = family_ == AdcFamily::kH7   ? 0x7FC10300u
                             : family_ == AdcFamily::kG0 ? 0x10000000u
                                                         : 0x70000000u;
  cr = (cr & ~kept) | (written & kept);
  if ((written & kAdcal) != 0) {
    cr &= ~kAdcal;  // calibrated at once
    if (family_ == AdcFamily::kG0) value(kIsr) |= kEocal;
    update();
  }
  if ((written & kAddis) != 0) {
    cr &= ~(kAden | kAdstart | kJadstart);
    value(kIsr) &= ~kAdrdy;
    stop(Group::kRegular);
    stop(Group::kInjected);
    return;
  }
  if ((written & kAden) != 0 && (cr & kAden) == 0) {
    cr |= kAden;
    value(kIsr) |= kAdrdy;
    if (family_ == AdcFamily::kH7 && field(ccr_, 16, 2) == 0) context().clocks.need(Bus::kAdc, name());
  }
  if ((written & kAdstp) != 0) {
    cr &= ~kAdstart;
    stop(Group::kRegular);
  }
  if ((written & kJadstp) != 0) {
    cr &= ~kJadstart;
    stop(Group::kInjected);
  }
  if ((cr & kAden) == 0) return;
  for (const Group group : {Group::kInjected, Group::kRegular}) {
    const std::uint32_t mask = group == Group::kRegular ? kAdstart : kJadstart;
    if ((written & mask) == 0 || (cr & mask) != 0 || length(group) == 0) continue;
    cr |= mask;
    if (trigger(group).second == 0) start(group);
  }
}

void AdcV2::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  registers_change();
  if (offset == kIsr) {
    value(kIsr) &= ~written;
  } else if (offset == kCr) {
    control(written);
  } else {
    keep(offset, written, lanes);
    if (offset == kChselr) count_selected();
    if (family_ == AdcFamily::kG0 && (offset == kChselr || offset == kCfgr)) value(kIsr) |= kCcrdy;
  }
  if (offset == kCr || offset == kCfgr || offset == kJsqr) listen();
  update();
}

AdcV2Common::AdcV2Common(const std::string& name, std::vector<AdcV2*> adcs, ChipContext& context)
    : RegisterBlock(name, context.system, kCommon),
      context_(context),
      adcs_(std::move(adcs)),
      group_([this](std::span<const std::uint32_t> results) { return deliver(results); }),
      dma_(context.dma.line(adcs_.front()->name())) {
  for (std::size_t i = 0; i < adcs_.size() && i < 2; ++i) group_.add(*adcs_[i]);  // a pair
}

// MDMA of CCR: 2 asks for pairs as words, 3 for pairs as bytes in a half-word.
std::size_t AdcV2Common::deliver(std::span<const std::uint32_t> results) {
  const unsigned dma = field(value(0x08), 14, 2);
  std::size_t taken = 0;
  for (; taken + 2 <= results.size(); taken += 2) {
    const std::uint32_t first = results[taken], second = results[taken + 1];
    value(0x0C) = dma == 3 ? (second & 0xFFu) << 8 | (first & 0xFFu) : second << 16 | first;
    if (dma >= 2) context_.dma.pulse(dma_);
  }
  return taken;
}

void AdcV2Common::reset() {
  RegisterBlock::reset();
  group_.reset();
  for (AdcV2* adc : adcs_) adc->set_common(0);
}

std::uint32_t AdcV2Common::load(std::uint32_t offset) {
  if (offset == 0x0C) {
    for (unsigned i = 0; group_.members() > 1 && i < group_.members(); ++i) adcs_[i]->data_was_read();
  }
  return shown(offset);
}

std::uint32_t AdcV2Common::shown(std::uint32_t offset) {
  if (offset != 0) return value(offset);
  std::uint32_t status = 0;
  for (std::size_t i = 0; i < adcs_.size() && i < 2; ++i) status |= (adcs_[i]->status() & 0x7FFu) << (16 * i);
  return status;
}

void AdcV2Common::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  keep(offset, written, lanes);
  for (AdcV2* adc : adcs_) adc->set_common(value(0x08));
  system().reschedule();
  if (offset != 0x08) return;
  group_.set(field(value(0x08), 0, 5), field(value(0x08), 8, 4) + 1);
  if (!group_.known()) system().report_unmodelled(name(), "CCR: a DUAL that is reserved");
}

}  // namespace omnihil::mcu
