#include "firmware_iface/mcu/stm32/clock/pwr.h"

#include "firmware_iface/mcu/stm32/register_rows.h"

namespace omnihil::mcu {
namespace {
constexpr RegisterInfo kF0F3[] = {{0x00, "CR", 0, 0x1FF, 0x16}, {0x04, "CSR", 0, 0x700, 0x700}};
constexpr RegisterInfo kF4[] = {{0x00, "CR", 0x0000C000, 0x003FFFF3, 0x12}, {0x04, "CSR", 0, 0x300, 0x100}};
constexpr RegisterInfo kF7[] = {{0x00, "CR1", 0x0000C000, 0x000FFFF3, 0x10},
                                {0x04, "CSR1", 0, 0x300, 0x100},
                                {0x08, "CR2", 0, 0x3F3F, 0x3F},
                                {0x0C, "CSR2", 0, 0x3F, 0x3F}};
// G4; L4: RM0351 5.4
constexpr RegisterInfo kControlOfG4[] = {{0x00, "CR1", 0x200, 0x4707, 0x4007},
                                         {0x04, "CR2", 0, 0xFF, 0xFF},
                                         {0x08, "CR3", 0x8000, 0xFFFF},
                                         {0x0C, "CR4", 0, 0xFFFF, 0x1F}};
constexpr RegisterInfo kControlOfL4[] = {{0x00, "CR1", 0x200, 0x4707, 0x4107},
                                         {0x04, "CR2", 0, 0x6FF, 0xFF},
                                         {0x08, "CR3", 0x8000, 0xFFFF},
                                         {0x0C, "CR4", 0, 0x31F, 0x1F}};
constexpr RegisterInfo kStatusAndPulls[] = {{0x10, "SR1", 0, 0}, {0x14, "SR2", 0x100, 0}, {0x18, "SCR", 0, 0},
                                            {0x20, "PUCRA"},     {0x24, "PDCRA"},         {0x28, "PUCRB"},
                                            {0x2C, "PDCRB"},     {0x30, "PUCRC"},         {0x34, "PDCRC"}};
constexpr RegisterInfo kCr5[] = {{0x80, "CR5", 0x100, 0x100}};
constexpr auto kG4 = joined(kControlOfG4, kStatusAndPulls, kCr5);
constexpr auto kL4 = joined(kControlOfL4, kStatusAndPulls);
// RM0444 4.4
constexpr RegisterInfo kG0[] = {
    {0x00, "CR1", 0x208, 0x473F, 0x4037},
    {0x04, "CR2", 0, 0x7FF, 0x1FF},
    {0x08, "CR3", 0x8000, 0xFFFF},
    {0x0C, "CR4", 0, 0x13F, 0x3F},
    {0x10, "SR1", 0, 0},
    {0x14, "SR2", 0x180, 0},
    {0x18, "SCR", 0, 0},
    {0x20, "PUCRA"},
    {0x24, "PDCRA"},
    {0x28, "PUCRB"},
    {0x2C, "PDCRB"},
    {0x30, "PUCRC"},
    {0x34, "PDCRC"},
    {0x38, "PUCRD"},
    {0x3C, "PDCRD"},
    {0x40, "PUCRE"},
    {0x44, "PDCRE"},
    {0x48, "PUCRF"},
    {0x4C, "PDCRF"},
};
// RM0433 6.8. Not followed: deep sleep, batteries, monitors, wake-up pins.
constexpr RegisterInfo kH7[] = {{0x00, "CR1", 0xF000C000, 0x0007C3F1, 0x000701F1},
                                {0x04, "CSR1", 0, 0},
                                {0x08, "CR2", 0, 0x11, 0x10},
                                {0x0C, "CR3", 0x6, 0x0300033F, 0x300},
                                {0x10, "CPUCR", 0, 0xE07, 0x7},
                                {0x18, "D3CR", 0x4000, 0xC000},
                                {0x20, "WKUPCR", 0, 0},
                                {0x24, "WKUPFR", 0, 0},
                                {0x28, "WKUPEPR", 0, 0x0FFF3F3F, 0x3F}};

std::span<const RegisterInfo> table(PwrFamily family) {
  switch (family) {
    case PwrFamily::kF0F3:
      return kF0F3;
    case PwrFamily::kF4:
      return kF4;
    case PwrFamily::kF7:
      return kF7;
    case PwrFamily::kG0:
      return kG0;
    case PwrFamily::kH7:
      return kH7;
    case PwrFamily::kL4:
      return kL4;
    case PwrFamily::kG4:
      break;
  }
  return kG4;
}

class Pwr final : public RegisterBlock {
 public:
  Pwr(PwrFamily family, ChipContext& context)
      : RegisterBlock("PWR", context.system, table(family)), family_(family) {}

 protected:
  std::uint32_t load(std::uint32_t offset) override {
    const std::uint32_t v = value(offset);
    if (family_ == PwrFamily::kH7) return v | ready_of_h7(offset);
    if (offset != 4 || (family_ != PwrFamily::kF4 && family_ != PwrFamily::kF7)) return v;
    const std::uint32_t cr = value(0);
    // VOSRDY; backup regulator BRR follows BRE; over-drive ODRDY, ODSWRDY follow ODEN, ODSWEN (F7, F446)
    return v | 1u << 14 | (v & 0x200u) >> 6 | (cr & 0x00030000u);
  }

 private:
  std::uint32_t ready_of_h7(std::uint32_t offset) const {
    switch (offset) {
      case 0x04:
        return 1u << 13 | (value(0x18) & 0xC000u);  // ACTVOSRDY, ACTVOS as VOS
      case 0x08:
        return (value(0x08) & 1u) << 16;  // BRRDY
      case 0x0C:
        return (value(0x0C) >> 24 & 1u) << 26;  // USB33RDY
      case 0x18:
        return 1u << 13;  // VOSRDY
      default:
        return 0;
    }
  }
  PwrFamily family_;
};
}  // namespace

std::unique_ptr<RegisterBlock> make_pwr(PwrFamily family, ChipContext& context) {
  return std::make_unique<Pwr>(family, context);
}

}  // namespace omnihil::mcu
