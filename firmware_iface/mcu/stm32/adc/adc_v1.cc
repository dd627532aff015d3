#include "firmware_iface/mcu/stm32/adc/adc_v1.h"

namespace omnihil::mcu {
namespace {
constexpr std::uint32_t kOvr = 1u << 5;                             // SR
constexpr std::uint32_t kJswstart = 1u << 22, kSwstart = 1u << 30;  // CR2

constexpr RegisterInfo kAdc[] = {{0x00, "SR", 0, 0},
                                 {0x04, "CR1", 0, 0x07C0FFFF, 0x00C01240},
                                 {0x08, "CR2", 0, 0x7F7F0F03},
                                 {0x0C, "SMPR1"},
                                 {0x10, "SMPR2"},
                                 {0x14, "JOFR1", 0, 0xFFF, 0xFFF},
                                 {0x18, "JOFR2", 0, 0xFFF, 0xFFF},
                                 {0x1C, "JOFR3", 0, 0xFFF, 0xFFF},
                                 {0x20, "JOFR4", 0, 0xFFF, 0xFFF},
                                 {0x24, "HTR", 0xFFF, 0xFFF},
                                 {0x28, "LTR", 0, 0xFFF},
                                 {0x2C, "SQR1"},
                                 {0x30, "SQR2"},
                                 {0x34, "SQR3"},
                                 {0x38, "JSQR"},
                                 {0x3C, "JDR1", 0, 0},
                                 {0x40, "JDR2", 0, 0},
                                 {0x44, "JDR3", 0, 0},
                                 {0x48, "JDR4", 0, 0},
                                 {0x4C, "DR", 0, 0}};
constexpr double kSampleClocks[] = {3, 15, 28, 56, 84, 112, 144, 480};
enum : std::uint16_t { kCcr = 0x04, kCdr = 0x08 };
constexpr RegisterInfo kCommon[] = {{0x00, "CSR", 0, 0}, {kCcr, "CCR", 0, 0x00C3EF1F}, {kCdr, "CDR", 0, 0}};
}  // namespace

AdcV1Common::AdcV1Common(ChipContext& context)
    : RegisterBlock("ADC", context.system, kCommon),
      context_(context),
      group_([this](std::span<const std::uint32_t> results) { return deliver(results); }),
      dma_(context.dma.line("ADC1")) {}

void AdcV1Common::add(AdcV1& adc) {
  adcs_.push_back(&adc);
  group_.add(adc);
}

void AdcV1Common::reset() {
  RegisterBlock::reset();
  group_.reset();
}

// CCR's DMA field: 1 asks for every result, 2 for pairs as words, 3 for pairs as bytes in a half-word. Without it the
// register has the master's and the first slave's.
std::size_t AdcV1Common::deliver(std::span<const std::uint32_t> results) {
  const unsigned dma = field(value(kCcr), 14, 2);
  std::size_t taken = 0;
  const std::size_t unit = dma == 1 ? 1 : 2;
  while (taken + unit <= results.size()) {
    const std::uint32_t first = results[taken], second = unit == 2 ? results[taken + 1] : 0u;
    value(kCdr) = dma == 3 ? (second & 0xFFu) << 8 | (first & 0xFFu) : second << 16 | first;
    if (dma == 0) return results.size();
    taken += unit;
    context_.dma.pulse(dma_);
  }
  return taken;
}

std::uint32_t AdcV1Common::load(std::uint32_t offset) {
  if (offset == kCdr) {
    for (unsigned i = 0; group_.members() > 1 && i < group_.members(); ++i) adcs_[i]->data_was_read();
  }
  return value(offset);
}

double AdcV1Common::clock_hz() const {
  return context_.clocks.bus_hz(Bus::kApb2) / (2.0 * (field(value(0x04), 16, 2) + 1));
}

void AdcV1Common::set_status(unsigned adc, std::uint32_t status) {
  std::uint32_t& csr = value(0x00);
  csr = (csr & ~(0x3Fu << (8 * adc))) | (status & 0x3Fu) << (8 * adc);
}

void AdcV1Common::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  for (AdcV1* adc : adcs_) adc->registers_change();
  system().reschedule();
  keep(offset, written, lanes);
  if (offset != kCcr) return;
  group_.set(field(value(kCcr), 0, 5), field(value(kCcr), 8, 4) + 5);
  if (!group_.known()) system().report_unmodelled(name(), "CCR: a MULTI that is reserved");
}

AdcV1::AdcV1(int number, int irq, AdcV1Common& common, const AdcTriggers& triggers, ChipContext& context)
    : AdcWithStatus("ADC" + std::to_string(number), {kAdc, kSampleClocks, kJswstart | kSwstart}, triggers,
                    context),
      common_(common),
      number_(static_cast<unsigned>(number - 1)),
      irq_(context.irqs, irq),
      dma_(context.dma.line("ADC" + std::to_string(number))) {
  common.add(*this);
}

unsigned AdcV1::bits() const { return 12 - 2 * field(value(kCr1), 24, 2); }

std::pair<int, unsigned> AdcV1::trigger(Group group) const {
  const std::uint32_t cr2 = value(kCr2);
  if (group == Group::kRegular) return {static_cast<int>(field(cr2, 24, 4)), field(cr2, 28, 2)};
  return {static_cast<int>(field(cr2, 16, 4)), field(cr2, 20, 2)};
}

void AdcV1::result(Group group, unsigned place, std::uint32_t code, bool last) {
  std::uint32_t& sr = value(kSr);
  if (group == Group::kInjected) {
    value(kJdr1 + 4 * place) = code;
    if (last) sr |= kJeoc;
    return update();
  }
  if ((sr & kEoc) != 0 && (by_dma() || bit(value(kCr2), 10))) sr |= kOvr;
  value(kDr) = code;
  // EOCS: a flag per conversion instead of one per sequence; DMA asks for each.
  const bool dma = by_dma();
  if (last || bit(value(kCr2), 10) || dma) sr |= kEoc;
  update();
  if (dma) context().dma.pulse(dma_);
}

void AdcV1::update() {
  const std::uint32_t sr = value(kSr);
  irq_.set(asks() || ((sr & kOvr) != 0 && bit(value(kCr1), 26)));
  common_.set_status(number_, sr);
}

void AdcV1::ordered(std::uint32_t, std::uint32_t written) {
  if ((written & kJswstart) != 0) start_with(Group::kInjected, kJstrt);
  if ((written & kSwstart) != 0) start_with(Group::kRegular, kStrt);
}

}  // namespace omnihil::mcu
