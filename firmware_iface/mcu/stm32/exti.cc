#include "firmware_iface/mcu/stm32/exti.h"

#include <utility>

namespace omnihil::mcu {
namespace {
constexpr RegisterInfo kSyscfg[] = {{0x00, "MEMRMP", 0, 0xFFFFFFFF, 0x704},
                                    {0x04, "PMC"},
                                    {0x08, "EXTICR1", 0, 0xFFFF},
                                    {0x0C, "EXTICR2", 0, 0xFFFF},
                                    {0x10, "EXTICR3", 0, 0xFFFF},
                                    {0x14, "EXTICR4", 0, 0xFFFF},
                                    {0x18, "CFGR2", 0, 0xFFFFFFFF, 0x7},
                                    {0x1C, "CBR", 0},
                                    {0x20, "CMPCR", 0, 0x1}};
// AFIO, RM0008 9.4. Boards name channels, not pins, so where a channel's pin is changes nothing here; not followed:
// TIM5's input from the LSI, triggers of the ADCs by TIM8.
constexpr RegisterInfo kAfio[] = {{0x00, "EVCR", 0, 0xFF, 0x80}, {0x04, "MAPR", 0, 0x071FFFFF, 0x001F0000},
                                  {0x08, "EXTICR1", 0, 0xFFFF},  {0x0C, "EXTICR2", 0, 0xFFFF},
                                  {0x10, "EXTICR3", 0, 0xFFFF},  {0x14, "EXTICR4", 0, 0xFFFF},
                                  {0x1C, "MAPR2", 0, 0x7E0}};
// RM0433 12.3. Not followed: boost of the analog switches, Ethernet's interface, the break lines of CFGR.
constexpr RegisterInfo kSyscfgOfH7[] = {{0x04, "PMCR", 0x0F000000, 0x0FE003FF, 0x00E00300},
                                        {0x08, "EXTICR1", 0, 0xFFFF},
                                        {0x0C, "EXTICR2", 0, 0xFFFF},
                                        {0x10, "EXTICR3", 0, 0xFFFF},
                                        {0x14, "EXTICR4", 0, 0xFFFF},
                                        {0x18, "CFGR", 0, 0xFEFD, 0xFEFD},
                                        {0x20, "CCCSR", 0, 0x10003},
                                        {0x24, "CCVR", 0x88, 0},
                                        {0x28, "CCCR", 0, 0xFF},
                                        {0x2C, "PWRCR", 0, 0xF},
                                        {0x30, "ADC2ALT", 0, 3, 3},
                                        {0x124, "PKGR", 0, 0},
                                        {0x300, "UR0", 0x00C60001, 0},
                                        {0x304, "UR1", 0, 0},
                                        {0x308, "UR2", 0x08000000},
                                        {0x30C, "UR3", 0x00001FF0},
                                        {0x310, "UR4", 0x1, 0},
                                        {0x314, "UR5", 0x00FF0000, 0},
                                        {0x328, "UR10", 0x00FF0000, 0},
                                        {0x334, "UR13", 0, 0},
                                        {0x338, "UR14", 0, 1},
                                        {0x340, "UR16", 0, 0},
                                        {0x344, "UR17", 0, 0}};
// RM0351 9.2
constexpr RegisterInfo kSyscfgOfL4[] = {{0x00, "MEMRMP", 0, 0x107, 0x104},
                                        {0x04, "CFGR1", 0x7C000001},
                                        {0x08, "EXTICR1", 0, 0xFFFF},
                                        {0x0C, "EXTICR2", 0, 0xFFFF},
                                        {0x10, "EXTICR3", 0, 0xFFFF},
                                        {0x14, "EXTICR4", 0, 0xFFFF},
                                        {0x18, "SCSR", 0, 1, 1},
                                        {0x1C, "CFGR2", 0, 0xF, 0xF},
                                        {0x20, "SWPR"},
                                        {0x24, "SKR", 0, 0xFF}};
// RM0444 8.1. Not followed: boost of the analog switches, the infrared output; lines that show whose an interrupt is.
constexpr RegisterInfo kSyscfgOfG0[] = {{0x00, "CFGR1", 0, 0xFFFFFFFF, 0x1E0},
                                        {0x18, "CFGR2", 0, 0xFFFFFFFF, 0x7}};
constexpr RegisterInfo kExti[] = {{0x00, "IMR"},   {0x04, "EMR"},      {0x08, "RTSR"},   {0x0C, "FTSR"},
                                  {0x10, "SWIER"}, {0x14, "PR", 0, 0}, {0x20, "IMR2"},   {0x24, "EMR2"},
                                  {0x28, "RTSR2"}, {0x2C, "FTSR2"},    {0x30, "SWIER2"}, {0x34, "PR2", 0, 0}};
// RM0433 20.6: of the three groups of lines each has these; those of D3 wake the domain, which never sleeps here.
constexpr RegisterInfo kExtiRegistersOfH7[] = {
    {0x00, "RTSR1"},   {0x04, "FTSR1"},        {0x08, "SWIER1"},
    {0x0C, "D3PMR1"},  {0x10, "D3PCR1L"},      {0x14, "D3PCR1H"},
    {0x20, "RTSR2"},   {0x24, "FTSR2"},        {0x28, "SWIER2"},
    {0x2C, "D3PMR2"},  {0x30, "D3PCR2L"},      {0x34, "D3PCR2H"},
    {0x40, "RTSR3"},   {0x44, "FTSR3"},        {0x48, "SWIER3"},
    {0x4C, "D3PMR3"},  {0x54, "D3PCR3H"},      {0x80, "CPUIMR1", 0xFFC00000},
    {0x84, "CPUEMR1"}, {0x88, "CPUPR1", 0, 0}, {0x90, "CPUIMR2"},
    {0x94, "CPUEMR2"}, {0x98, "CPUPR2", 0, 0}, {0xA0, "CPUIMR3"},
    {0xA4, "CPUEMR3"}, {0xA8, "CPUPR3", 0, 0}};
// RM0444 13.5
constexpr RegisterInfo kExtiRegistersOfG0[] = {{0x00, "RTSR1"},
                                               {0x04, "FTSR1"},
                                               {0x08, "SWIER1"},
                                               {0x0C, "RPR1", 0, 0},
                                               {0x10, "FPR1", 0, 0},
                                               {0x20, "RTSR2"},
                                               {0x24, "FTSR2"},
                                               {0x28, "SWIER2"},
                                               {0x2C, "RPR2", 0, 0},
                                               {0x30, "FPR2", 0, 0},
                                               {0x60, "EXTICR1"},
                                               {0x64, "EXTICR2"},
                                               {0x68, "EXTICR3"},
                                               {0x6C, "EXTICR4"},
                                               {0x80, "IMR1", 0xFFF80000},
                                               {0x84, "EMR1"},
                                               {0x90, "IMR2", 0xFFFFFFFF},
                                               {0x94, "EMR2"}};

std::span<const RegisterInfo> selection(SyscfgFamily family) {
  switch (family) {
    case SyscfgFamily::kF1:
      return kAfio;
    case SyscfgFamily::kG0:
      return kSyscfgOfG0;
    case SyscfgFamily::kH7:
      return kSyscfgOfH7;
    case SyscfgFamily::kL4:
      return kSyscfgOfL4;
    default:
      return kSyscfg;
  }
}
}  // namespace

const ExtiMap kExtiUsual{kExti, 0x00, 0x04, 0x08, 0x0C, 0x10, 0x14};
const ExtiMap kExtiG0{kExtiRegistersOfG0, 0x80, 0x84, 0x00, 0x04, 0x08, 0x0C, 0x10, 0x60};
const ExtiMap kExtiH7{kExtiRegistersOfH7, 0x80, 0x84, 0x00, 0x04, 0x08, 0x88};

Syscfg::Syscfg(ChipContext& context, SyscfgFamily family)
    : RegisterBlock(family == SyscfgFamily::kF1 ? "AFIO" : "SYSCFG", context.system, selection(family)),
      family_(family) {}

std::uint32_t Syscfg::load(std::uint32_t offset) {
  const std::uint32_t v = value(offset);
  const bool old = family_ == SyscfgFamily::kUsual || family_ == SyscfgFamily::kF7;
  return offset == 0x20 && (old || family_ == SyscfgFamily::kH7) ? v | (v & 1u) << 8
                                                                 : v;  // compensation cell ready
}

void Syscfg::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  const std::uint32_t before = value(0) & 3u;
  keep(offset, written, lanes);
  const std::uint32_t mode = value(0) & 3u;
  const bool remaps =
      family_ == SyscfgFamily::kUsual || family_ == SyscfgFamily::kG0 || family_ == SyscfgFamily::kL4;
  if (offset != 0 || mode == before || !remaps) return;
  constexpr std::uint32_t kShown[] = {0x08000000u, 0x1FFF0000u, 0x08000000u, 0x20000000u};
  system().map_at_zero(kShown[mode]);
}

Exti::Exti(const Syscfg& syscfg, std::vector<ExtiVector> vectors, const ExtiMap& map, ChipContext& context)
    : RegisterBlock("EXTI", context.system, map.registers),
      map_(map),
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
  if (port_of(pin) != port) return;
  triggers_.fire(trigger_[pin], level);
  const std::uint32_t edges = value(level ? map_.rtsr : map_.ftsr);
  if (bit(edges, pin)) raise(1u << pin, !level);
}

unsigned Exti::port_of(unsigned line) const {
  if (map_.ports == 0) return syscfg_.port_of(line);
  return field(value(map_.ports + 4 * (line / 4)), 8 * (line % 4), 8);
}

void Exti::raise(std::uint32_t lines, bool fell) {
  value(fell && map_.fallen != 0 ? map_.fallen : map_.pr) |= lines & (value(map_.imr) | value(map_.emr));
  update();
}

void Exti::update() {
  const std::uint32_t fallen = map_.fallen != 0 ? value(map_.fallen) : 0;
  const std::uint32_t pending = (value(map_.pr) | fallen) & value(map_.imr);
  for (std::size_t i = 0; i < vectors_.size(); ++i) {
    const std::uint32_t mask = field(0xFFFFFFFFu >> (31 - vectors_[i].last), vectors_[i].first, 16);
    lines_[i].set((pending >> vectors_[i].first & mask) != 0);
  }
}

void Exti::store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) {
  if (offset == map_.pr) {
    value(map_.pr) &= ~written;
    value(map_.swier) &= ~written;
  } else if (map_.fallen != 0 && offset == map_.fallen) {
    value(map_.fallen) &= ~written;
  } else if (map_.fallen != 0 && offset == map_.swier) {
    raise(written);
  } else if (offset == map_.swier) {
    const std::uint32_t fresh = written & ~value(map_.swier);
    keep(offset, written, lanes);
    raise(fresh);
  } else {
    keep(offset, written, lanes);
  }
  update();
}

}  // namespace omnihil::mcu
