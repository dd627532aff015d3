#include "firmware_iface/mcu/stm32/exti.h"

#include <utility>

namespace omnihil::mcu {
namespace {
enum : std::uint16_t { kImr = 0x00, kEmr = 0x04, kRtsr = 0x08, kFtsr = 0x0C, kSwier = 0x10, kPr = 0x14 };

constexpr RegisterInfo kSyscfg[] = {{0x00, "MEMRMP", 0, 0xFFFFFFFF, 0x704},
                                    {0x04, "PMC"},
                                    {0x08, "EXTICR1", 0, 0xFFFF},
                                    {0x0C, "EXTICR2", 0, 0xFFFF},
                                    {0x10, "EXTICR3", 0, 0xFFFF},
                                    {0x14, "EXTICR4", 0, 0xFFFF},
                                    {0x18, "CFGR2", 0, 0xFFFFFFFF, 0x7},
                                    {0x1C, "CBR", 0},
                                    {0x20, "CMPCR", 0, 0x1}};
constexpr RegisterInfo kExti[] = {
    {kImr, "IMR"},  {kEmr, "EMR"},  {kRtsr, "RTSR"}, {kFtsr, "FTSR"}, {kSwier, "SWIER"}, {kPr, "PR", 0, 0},
    {0x20, "IMR2"}, {0x24, "EMR2"}, {0x28, "RTSR2"}, {0x2C, "FTSR2"}, {0x30, "SWIER2"},  {0x34, "PR2", 0, 0}};
}  // namespace

Syscfg::Syscfg(ChipContext& context, bool remaps_zero)
    : RegisterBlock("SYSCFG", context.system, kSyscfg), remaps_zero_(remaps_zero) {}

std::uint32_t Syscfg::load(std::uint32_t offset) {
  const std::uint32_t v = value(offset);
  return offset == 0x20 ? v | (v & 1u) << 8 : v;  // compensation cell ready
}

void Syscfg::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  const std::uint32_t before = value(0) & 3u;
  keep(offset, written, lanes);
  const std::uint32_t mode = value(0) & 3u;
  if (offset != 0 || mode == before || !remaps_zero_) return;
  constexpr std::uint32_t kShown[] = {0x08000000u, 0x1FFF0000u, 0x08000000u, 0x20000000u};
  system().map_at_zero(kShown[mode]);
}

Exti::Exti(const Syscfg& syscfg, std::vector<ExtiVector> vectors, ChipContext& context)
    : RegisterBlock("EXTI", context.system, kExti),
      syscfg_(syscfg),
      vectors_(std::move(vectors)),
      triggers_(context.triggers) {
  for (const ExtiVector& v : vectors_) lines_.emplace_back(context.irqs, v.irq);
  for (int i = 0; i < 16; ++i) trigger_[i] = triggers_.source("EXTI" + std::to_string(i));
}

void Exti::reset() {
  RegisterBlock::reset();
  update();
}

void Exti::pin_changed(unsigned port, unsigned pin, bool level) {
  if (syscfg_.port_of(pin) != port) return;
  triggers_.fire(trigger_[pin], level);
  const std::uint32_t edges = value(level ? kRtsr : kFtsr);
  if (bit(edges, pin)) raise(1u << pin);
}

void Exti::raise(std::uint32_t lines) {
  value(kPr) |= lines & (value(kImr) | value(kEmr));
  update();
}

void Exti::update() {
  const std::uint32_t pending = value(kPr) & value(kImr);
  for (std::size_t i = 0; i < vectors_.size(); ++i) {
    const std::uint32_t mask = field(0xFFFFFFFFu >> (31 - vectors_[i].last), vectors_[i].first, 16);
    lines_[i].set((pending >> vectors_[i].first & mask) != 0);
  }
}

void Exti::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == kPr) {
    value(kPr) &= ~written;
    value(kSwier) &= ~written;
  } else if (offset == kSwier) {
    const std::uint32_t fresh = written & ~value(kSwier);
    keep(offset, written, lanes);
    raise(fresh);
  } else {
    keep(offset, written, lanes);
  }
  update();
}

}  // namespace omnihil::mcu
