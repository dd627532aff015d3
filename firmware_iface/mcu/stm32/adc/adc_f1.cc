#include "firmware_iface/mcu/stm32/adc/adc_f1.h"

namespace omnihil::mcu {
namespace {
// CR2
constexpr std::uint32_t kAdon = 1u << 0, kCal = 1u << 2, kRstcal = 1u << 3, kJswstart = 1u << 21,
                        kSwstart = 1u << 22;
constexpr unsigned kBySoftware = 7;  // EXTSEL, JEXTSEL

constexpr RegisterInfo kAdc[] = {{0x00, "SR", 0, 0},
                                 {0x04, "CR1", 0, 0x00CFFFFF, 0x00C01240},
                                 {0x08, "CR2", 0, 0x00FEF90F},
                                 {0x0C, "SMPR1", 0, 0x00FFFFFF},
                                 {0x10, "SMPR2", 0, 0x3FFFFFFF},
                                 {0x14, "JOFR1", 0, 0xFFF, 0xFFF},
                                 {0x18, "JOFR2", 0, 0xFFF, 0xFFF},
                                 {0x1C, "JOFR3", 0, 0xFFF, 0xFFF},
                                 {0x20, "JOFR4", 0, 0xFFF, 0xFFF},
                                 {0x24, "HTR", 0xFFF, 0xFFF},
                                 {0x28, "LTR", 0, 0xFFF},
                                 {0x2C, "SQR1", 0, 0x00FFFFFF},
                                 {0x30, "SQR2", 0, 0x3FFFFFFF},
                                 {0x34, "SQR3", 0, 0x3FFFFFFF},
                                 {0x38, "JSQR", 0, 0x003FFFFF},
                                 {0x3C, "JDR1", 0, 0},
                                 {0x40, "JDR2", 0, 0},
                                 {0x44, "JDR3", 0, 0},
                                 {0x48, "JDR4", 0, 0},
                                 {0x4C, "DR", 0, 0}};
constexpr double kSampleClocks[] = {1.5, 7.5, 13.5, 28.5, 41.5, 55.5, 71.5, 239.5};
}  // namespace

AdcF1::AdcF1(const AdcF1Spec& spec, const AdcTriggers& triggers, AdcF1* master, ChipContext& context)
    : AdcWithStatus("ADC" + std::to_string(spec.number),
                    {kAdc, kSampleClocks, kCal | kRstcal | kJswstart | kSwstart}, triggers, context),
      pair_([this](std::span<const std::uint32_t> results) { return deliver(results); }),
      irq_(context.irqs, spec.irq),
      dma_(spec.dma ? context.dma.line(name()) : -1) {
  if (master == nullptr) {
    pair_.add(*this);
  } else {
    master->pair_.add(*this);
  }
}

void AdcF1::reset() {
  AdcWithStatus::reset();
  pair_.reset();
}

// Both results of a rank: the master's register shows the slave's above its own.
std::size_t AdcF1::deliver(std::span<const std::uint32_t> results) {
  std::size_t taken = 0;
  for (; taken + 2 <= results.size(); taken += 2) value(kDr) = results[taken + 1] << 16 | results[taken];
  if (taken > 0 && dma_ >= 0 && by_dma()) context().dma.pulse(dma_);
  return taken;
}

unsigned AdcF1::length(Group group) const {
  return bit(value(kCr1), 8) ? AdcWithStatus::length(group) : 1;  // SCAN
}

std::pair<int, unsigned> AdcF1::trigger(Group group) const {
  const std::uint32_t cr2 = value(kCr2);
  const unsigned select = group == Group::kRegular ? field(cr2, 17, 3) : field(cr2, 12, 3);
  const bool external = bit(cr2, group == Group::kRegular ? 20 : 15);
  if (select == kBySoftware) return {-1, 0};
  return {static_cast<int>(select), external ? 1u : 0u};
}

void AdcF1::result(Group group, unsigned place, std::uint32_t code, bool last) {
  std::uint32_t& sr = value(kSr);
  if (group == Group::kInjected) {
    value(kJdr1 + 4 * place) = code;
    if (last) sr |= kJeoc | kEoc;
    return update();
  }
  value(kDr) = code;
  const bool dma = dma_ >= 0 && by_dma();
  if (last || dma) sr |= kEoc;
  update();
  if (dma && pair_.members() < 2) context().dma.pulse(dma_);
}

void AdcF1::update() { irq_.set(asks()); }

void AdcF1::ordered(std::uint32_t before, std::uint32_t written) {
  const std::uint32_t cr2 = value(kCr2);
  // ADON alone, written again, starts; with another change beside it, it does not (RM0008 11.3.1).
  const bool again = (before & kAdon) != 0 && (written & kAdon) != 0 && cr2 == before &&
                     (written & (kCal | kRstcal | kJswstart | kSwstart)) == 0;
  const auto by_software = [&](Group group, unsigned enable) {
    return trigger(group).first < 0 && bit(cr2, enable);
  };
  if ((written & kJswstart) != 0 && by_software(Group::kInjected, 15)) start_with(Group::kInjected, kJstrt);
  if (again || ((written & kSwstart) != 0 && by_software(Group::kRegular, 20)))
    start_with(Group::kRegular, kStrt);
}

void AdcF1::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  AdcWithStatus::store(offset, written, lanes);
  if (offset == kCr1) {
    constexpr unsigned kFastDelay = 7, kSlowDelay = 14;  // clocks between the two (RM0008 11.9.3, 11.9.4)
    const unsigned mode = field(value(kCr1), 16, 4);
    const bool slow = mode == 4 || mode == 8;
    pair_.set(slow ? mode - 1 : mode, slow ? kSlowDelay : kFastDelay);
    if (!pair_.known()) system().report_unmodelled(name(), "CR1: a DUALMOD that is reserved");
  }
}

}  // namespace omnihil::mcu
