#include "firmware_iface/mcu/rp2040/kept_blocks.h"

namespace omnihil::mcu::rp2040 {
namespace {
class Kept : public Rp2040Block {
 public:
  Kept(std::string name, std::span<const RegisterInfo> rows, ChipContext& context)
      : Rp2040Block(std::move(name), context.system, rows) {
    next_event_is(kNever);
  }
};

constexpr RegisterInfo kSysinfo[] = {{0x00, "CHIP_ID", 0x20002927, 0},  // revision B2
                                     {0x04, "PLATFORM", 0x2, 0},        // ASIC
                                     {0x40, "GITREF_RP2040", 0, 0}};
constexpr RegisterInfo kSyscfg[] = {{0x00, "PROC0_NMI_MASK", 0, 0xFFFFFFFF, 0xFFFFFFFF},
                                    {0x04, "PROC1_NMI_MASK", 0, 0xFFFFFFFF, 0xFFFFFFFF},
                                    {0x08, "PROC_CONFIG", 0x10000000, 0xFF000000},
                                    {0x0C, "PROC_IN_SYNC_BYPASS", 0, 0x3FFFFFFF},
                                    {0x10, "PROC_IN_SYNC_BYPASS_HI", 0, 0x3F},
                                    {0x14, "DBGFORCE", 0x66, 0xEE},
                                    {0x18, "MEMPOWERDOWN", 0, 0xFF, 0xFF}};
constexpr RegisterInfo kVreg[] = {
    {0x00, "VREG", 0xB1, 0xF3}, {0x04, "BOD", 0x91, 0xF1}, {0x08, "CHIP_RESET", 0, 0}};
constexpr RegisterInfo kBus[] = {{0x00, "BUS_PRIORITY", 0, 0x1111}, {0x04, "BUS_PRIORITY_ACK", 1, 0},
                                 {0x08, "PERFCTR0", 0, 0},          {0x0C, "PERFSEL0", 0x1F, 0x1F},
                                 {0x10, "PERFCTR1", 0, 0},          {0x14, "PERFSEL1", 0x1F, 0x1F},
                                 {0x18, "PERFCTR2", 0, 0},          {0x1C, "PERFSEL2", 0x1F, 0x1F},
                                 {0x20, "PERFCTR3", 0, 0},          {0x24, "PERFSEL3", 0x1F, 0x1F}};
constexpr RegisterInfo kTbman[] = {{0x00, "PLATFORM", 0x1, 0}};
constexpr RegisterInfo kPadsQspi[] = {
    {0x00, "VOLTAGE_SELECT", 0, 1},      {0x04, "GPIO_QSPI_SCLK", 0x56, 0xFF},
    {0x08, "GPIO_QSPI_SD0", 0x52, 0xFF}, {0x0C, "GPIO_QSPI_SD1", 0x52, 0xFF},
    {0x10, "GPIO_QSPI_SD2", 0x52, 0xFF}, {0x14, "GPIO_QSPI_SD3", 0x52, 0xFF},
    {0x18, "GPIO_QSPI_SS", 0x5A, 0xFF}};

class Vreg final : public Kept {
 public:
  explicit Vreg(ChipContext& context) : Kept("VREG_AND_CHIP_RESET", kVreg, context) {}

 protected:
  std::uint32_t load(std::uint32_t offset) override {
    constexpr std::uint32_t kInRange = 1u << 12, kHadPowerOn = 1u << 8;
    if (offset == 0x00) return value(offset) | kInRange;
    return offset == 0x08 && system().reset_cause() == "power-on" ? kHadPowerOn : value(offset);
  }
};
}  // namespace

std::unique_ptr<Rp2040Block> make_sysinfo(ChipContext& context) {
  return std::make_unique<Kept>("SYSINFO", kSysinfo, context);
}
std::unique_ptr<Rp2040Block> make_syscfg(ChipContext& context) {
  return std::make_unique<Kept>("SYSCFG", kSyscfg, context);
}
std::unique_ptr<Rp2040Block> make_vreg_and_chip_reset(ChipContext& context) {
  return std::make_unique<Vreg>(context);
}
std::unique_ptr<Rp2040Block> make_busctrl(ChipContext& context) {
  return std::make_unique<Kept>("BUSCTRL", kBus, context);
}
std::unique_ptr<Rp2040Block> make_tbman(ChipContext& context) {
  return std::make_unique<Kept>("TBMAN", kTbman, context);
}
std::unique_ptr<Rp2040Block> make_pads_qspi(ChipContext& context) {
  return std::make_unique<Kept>("PADS_QSPI", kPadsQspi, context);
}

}  // namespace omnihil::mcu::rp2040
