// RCC of F1, low to extra-high density (RM0008 §7).
#include <algorithm>

#include "firmware_iface/mcu/stm32/clock/rcc.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t { kCr = 0x00, kCfgr = 0x04, kBdcr = 0x20, kCsr = 0x24 };

constexpr RegisterInfo kRegisters[] = {
    {kCr, "CR", 0x00000083, 0x010D00F9, 0x00080000},
    {kCfgr, "CFGR", 0, 0x077FFFF3, 0x07000000},
    {0x08, "CIR", 0, 0x00001F00, 0x00001F00},
    {0x0C, "APB2RSTR", 0},
    {0x10, "APB1RSTR", 0},
    {0x14, "AHBENR", 0x00000014},
    {0x18, "APB2ENR", 0},
    {0x1C, "APB1ENR", 0},
    {kBdcr, "BDCR", 0, 0x00018305, 0x00018000},
    {kCsr, "CSR", 0, 0x00000001},
};

constexpr RccReady kReady[] = {{kCr, 0x01010001}, {kBdcr, 1}, {kCsr, 1}};
constexpr std::uint16_t kTree[] = {kCr, kCfgr};
constexpr RccMap kMap{.registers = kRegisters,
                      .ready = kReady,
                      .tree = kTree,
                      .cfgr = kCfgr,
                      .csr = kCsr,
                      .rmvf = 24,
                      .hsi = 0,
                      .hsi_hz = 8e6};

class RccF1 final : public Rcc {
 public:
  explicit RccF1(ChipContext& context) : Rcc(kMap, context) { clocks().lsi_hz = 40e3; }

 protected:
  double pll_hz() {
    const std::uint32_t cfgr = value(kCfgr);
    // PLL input: HSI / 2, or HSE, halved by PLLXTPRE; output: input times 2 .. 16
    const double hse_hz = clocks().hse_hz / (bit(cfgr, 17) ? 2 : 1);
    return (bit(cfgr, 16) ? hse_hz : clocks().hsi_hz / 2) * std::min(field(cfgr, 18, 4) + 2, 16u);
  }

  ClockState tree() override {
    const std::uint32_t cfgr = value(kCfgr), wanted = cfgr & 3u;
    select(wanted, wanted == 1 ? clocks().hse_hz : pll_hz());
    const std::uint32_t apb2 = apb_divider(field(cfgr, 11, 3));
    ClockState state =
        buses(sysclk_hz(), ahb_divider(field(cfgr, 4, 4)), apb_divider(field(cfgr, 8, 3)), apb2);
    state.of(Bus::kAdc) = {1, apb2 * 2 * (field(cfgr, 14, 2) + 1)};  // ADCPRE
    return state;
  }
};
}  // namespace

std::unique_ptr<Rcc> make_rcc_f1(ChipContext& context) { return std::make_unique<RccF1>(context); }

}  // namespace omnihil::mcu
