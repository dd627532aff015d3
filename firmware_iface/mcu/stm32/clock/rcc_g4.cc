// RCC of G4 (RM0440 §7).
#include "firmware_iface/mcu/stm32/clock/rcc.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t { kCr = 0x00, kCfgr = 0x08, kPllCfgr = 0x0C, kBdcr = 0x90, kCsr = 0x94, kCrrcr = 0x98 };

constexpr RegisterInfo kRegisters[] = {
    {kCr, "CR", 0x00000100, 0x010D0300, 0x00080200},
    {0x04, "ICSCR", 0x40000000, 0x7F000000},
    {kCfgr, "CFGR", 0x00000001, 0x7F003FF3, 0x7F000000},
    {kPllCfgr, "PLLCFGR", 0x00001000, 0xFF737FF3},
    {0x18, "CIER", 0, 0xFFFFFFFF, 0xFFFFFFFF},
    {0x1C, "CIFR", 0, 0},
    {0x20, "CICR", 0, 0},
    {0x28, "AHB1RSTR"},
    {0x2C, "AHB2RSTR"},
    {0x30, "AHB3RSTR"},
    {0x38, "APB1RSTR1"},
    {0x3C, "APB1RSTR2"},
    {0x40, "APB2RSTR"},
    {0x48, "AHB1ENR", 0x00000100},
    {0x4C, "AHB2ENR"},
    {0x50, "AHB3ENR"},
    {0x58, "APB1ENR1", 0x00000400},
    {0x5C, "APB1ENR2"},
    {0x60, "APB2ENR"},
    {0x68, "AHB1SMENR", 0x0000130F},
    {0x6C, "AHB2SMENR", 0x050F667F},
    {0x70, "AHB3SMENR", 0x00000101},
    {0x78, "APB1SMENR1", 0xD2FECD3F},
    {0x7C, "APB1SMENR2", 0x00000103},
    {0x80, "APB2SMENR", 0x0437F801},
    {0x88, "CCIPR", 0, 0xFFFFFFFF, 0x00000FFF},
    {kBdcr, "BDCR", 0, 0x0301837D, 0x00018000},
    {kCsr, "CSR", 0, 0x00000001},
    {kCrrcr, "CRRCR", 0, 0x00000001},
    {0x9C, "CCIPR2"},
};

constexpr RccReady kReady[] = {{kCr, 0x01010000}, {kCr, 0x100, 2}, {kBdcr, 1}, {kCrrcr, 1}, {kCsr, 1}};
constexpr std::uint16_t kTree[] = {kCr, kPllCfgr, kCfgr};
constexpr RccMap kMap{.registers = kRegisters,
                      .ready = kReady,
                      .tree = kTree,
                      .cfgr = kCfgr,
                      .csr = kCsr,
                      .rmvf = 23,
                      .switches = {-1, 8, 16, 24},
                      .hsi = 1,
                      .hsi_hz = 16e6};

class RccG4 final : public Rcc {
 public:
  RccG4(ChipContext& context) : Rcc(kMap, context) {}

 protected:
  double pll_hz() {
    const std::uint32_t v = value(kPllCfgr);
    const double input_hz = field(v, 0, 2) == 3 ? clocks().hse_hz : clocks().hsi_hz;
    // f(PLL_R) = f(in) N / (M R)
    return input_hz / (field(v, 4, 4) + 1) * field(v, 8, 7) / (2.0 * (field(v, 25, 2) + 1));
  }

  ClockState tree() override {
    const std::uint32_t cfgr = value(kCfgr), wanted = cfgr & 3u;
    select(wanted, wanted == 2 ? clocks().hse_hz : pll_hz());
    return buses(sysclk_hz(), ahb_divider(field(cfgr, 4, 4)), apb_divider(field(cfgr, 8, 3)),
                 apb_divider(field(cfgr, 11, 3)));
  }
};
}  // namespace

std::unique_ptr<Rcc> make_rcc_g4(ChipContext& context) { return std::make_unique<RccG4>(context); }

}  // namespace omnihil::mcu
