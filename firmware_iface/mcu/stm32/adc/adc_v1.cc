#include "firmware_iface/mcu/stm32/adc/adc_v1.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kSr = 0x00,
  kCr1 = 0x04,
  kCr2 = 0x08,
  kSmpr1 = 0x0C,
  kSmpr2 = 0x10,
  kSqr1 = 0x2C,
  kSqr3 = 0x34,
  kJsqr = 0x38,
  kJdr1 = 0x3C,
  kDr = 0x4C
};
constexpr std::uint32_t kEoc = 1u << 1, kJeoc = 1u << 2, kJstrt = 1u << 3, kStrt = 1u << 4, kOvr = 1u << 5;

constexpr RegisterInfo kAdc[] = {{kSr, "SR", 0, 0},
                                 {kCr1, "CR1", 0, 0x07C0FFFF, 0x00C01240},
                                 {kCr2, "CR2", 0, 0x7F7F0F03},
                                 {kSmpr1, "SMPR1"},
                                 {kSmpr2, "SMPR2"},
                                 {0x14, "JOFR1", 0, 0xFFF, 0xFFF},
                                 {0x18, "JOFR2", 0, 0xFFF, 0xFFF},
                                 {0x1C, "JOFR3", 0, 0xFFF, 0xFFF},
                                 {0x20, "JOFR4", 0, 0xFFF, 0xFFF},
                                 {0x24, "HTR", 0xFFF, 0xFFF},
                                 {0x28, "LTR", 0, 0xFFF},
                                 {kSqr1, "SQR1"},
                                 {0x30, "SQR2"},
                                 {kSqr3, "SQR3"},
                                 {kJsqr, "JSQR"},
                                 {kJdr1, "JDR1", 0, 0},
                                 {0x40, "JDR2", 0, 0},
                                 {0x44, "JDR3", 0, 0},
                                 {0x48, "JDR4", 0, 0},
                                 {kDr, "DR", 0, 0}};
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
  keep(offset, written, lanes);
  if (offset != kCcr) return;
  group_.set(field(value(kCcr), 0, 5), field(value(kCcr), 8, 4) + 5);
  if (!group_.known()) system().report_unmodelled(name(), "CCR: a MULTI that is reserved");
}

AdcV1::AdcV1(int number, int irq, AdcV1Common& common, const AdcTriggers& triggers, ChipContext& context)
    : Adc("ADC" + std::to_string(number), kAdc, triggers, context),
      common_(common),
      number_(static_cast<unsigned>(number - 1)),
      irq_(context.irqs, irq),
      dma_(context.dma.line("ADC" + std::to_string(number))) {
  common.add(*this);
}

void AdcV1::data_was_read() {
  value(kSr) &= ~kEoc;
  update();
}

void AdcV1::reset() {
  Adc::reset();
  update();
}

unsigned AdcV1::length(Group group) const {
  if (group == Group::kInjected) return field(value(kJsqr), 20, 2) + 1;
  return bit(value(kCr1), 8) ? field(value(kSqr1), 20, 4) + 1 : 1;  // SCAN
}

unsigned AdcV1::channel(Group group, unsigned place) const {
  if (group == Group::kInjected) {  // the sequence ends at JSQ4
    return field(value(kJsqr), 5 * (4 - length(group) + place), 5);
  }
  return field(value(kSqr3 - 4 * (place / 6)), 5 * (place % 6), 5);
}

double AdcV1::sample_clocks(unsigned channel) const {
  constexpr double kClocks[] = {3, 15, 28, 56, 84, 112, 144, 480};
  return kClocks[channel < 10 ? field(value(kSmpr2), 3 * channel, 3)
                              : field(value(kSmpr1), 3 * (channel % 10), 3)];
}

unsigned AdcV1::bits() const { return 12 - 2 * field(value(kCr1), 24, 2); }
bool AdcV1::left_aligned() const { return bit(value(kCr2), 11); }
bool AdcV1::continues() const { return bit(value(kCr2), 1); }
bool AdcV1::one_per_trigger() const { return bit(value(kCr1), 11); }
bool AdcV1::injected_follow() const { return bit(value(kCr1), 10); }

std::pair<int, unsigned> AdcV1::trigger(Group group) const {
  const std::uint32_t cr2 = value(kCr2);
  if (group == Group::kRegular) return {static_cast<int>(field(cr2, 24, 4)), field(cr2, 28, 2)};
  return {static_cast<int>(field(cr2, 16, 4)), field(cr2, 20, 2)};
}

bool AdcV1::armed(Group) const { return bit(value(kCr2), 0); }

void AdcV1::result(Group group, unsigned place, std::uint32_t code, bool last) {
  std::uint32_t& sr = value(kSr);
  if (group == Group::kInjected) {
    value(kJdr1 + 4 * place) = code;
    if (last) sr |= kJeoc;
    return update();
  }
  if ((sr & kEoc) != 0 && (bit(value(kCr2), 8) || bit(value(kCr2), 10))) sr |= kOvr;
  value(kDr) = code;
  // EOCS: a flag per conversion instead of one per sequence; DMA asks for each.
  const bool dma = bit(value(kCr2), 8);
  if (last || bit(value(kCr2), 10) || dma) sr |= kEoc;
  update();
  if (dma) context().dma.pulse(dma_);
}

void AdcV1::update() {
  const std::uint32_t sr = value(kSr), cr1 = value(kCr1);
  irq_.set(((sr & kEoc) != 0 && bit(cr1, 5)) || ((sr & kJeoc) != 0 && bit(cr1, 7)) ||
           ((sr & kOvr) != 0 && bit(cr1, 26)));
  common_.set_status(number_, sr);
}

std::uint32_t AdcV1::load(std::uint32_t offset) {
  if (offset == kDr) data_was_read();
  return value(offset);
}

void AdcV1::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  constexpr std::uint32_t kJswstart = 1u << 22, kSwstart = 1u << 30;
  if (offset == kSr) {
    value(kSr) &= written | ~lanes;
    return update();
  }
  keep(offset, written, lanes);
  if (offset == kCr2) {
    value(kCr2) &= ~(kJswstart | kSwstart);
    if (!bit(value(kCr2), 0)) {
      stop(Group::kRegular);
      stop(Group::kInjected);
    } else {
      if ((written & kJswstart) != 0) {
        value(kSr) |= kJstrt;
        start(Group::kInjected);
      }
      if ((written & kSwstart) != 0) {
        value(kSr) |= kStrt;
        start(Group::kRegular);
      }
    }
  }
  if (offset == kCr1 || offset == kCr2) listen();
  update();
}

}  // namespace omnihil::mcu
