// RCC of F4 (RM0090 §7, RM0390 §6) and F7 (RM0410 §5).
#include <algorithm>

#include "firmware_iface/mcu/stm32/clock/rcc.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kCr = 0x00,
  kPllCfgr = 0x04,
  kCfgr = 0x08,
  kBdcr = 0x70,
  kCsr = 0x74,
  kPllSaiCfgr = 0x88,
  kDckCfgr = 0x8C,
  kDckCfgr2 = 0x90
};

constexpr RegisterInfo kRegisters[] = {
    {kCr, "CR", 0x00000083, 0x550D00F9, 0x00080000},
    {kPllCfgr, "PLLCFGR", 0x24003010, 0x7F437FFF},
    {kCfgr, "CFGR", 0, 0xFFFFFCF3, 0xFFE00000},
    {0x0C, "CIR", 0, 0x00007F00, 0x00007F00},
    {0x10, "AHB1RSTR", 0, 0xFFFFFFFF, 0},
    {0x14, "AHB2RSTR", 0, 0xFFFFFFFF, 0},
    {0x18, "AHB3RSTR", 0, 0xFFFFFFFF, 0},
    {0x20, "APB1RSTR", 0, 0xFFFFFFFF, 0},
    {0x24, "APB2RSTR", 0, 0xFFFFFFFF, 0},
    {0x30, "AHB1ENR", 0x00100000},
    {0x34, "AHB2ENR", 0},
    {0x38, "AHB3ENR", 0},
    {0x40, "APB1ENR", 0},
    {0x44, "APB2ENR", 0},
    {0x50, "AHB1LPENR", 0x7E6791FF},
    {0x54, "AHB2LPENR", 0x000000F1},
    {0x58, "AHB3LPENR", 0x00000001},
    {0x60, "APB1LPENR", 0x36FEC9FF},
    {0x64, "APB2LPENR", 0x00075F33},
    {kBdcr, "BDCR", 0, 0x0001831D, 0x00018000},
    {kCsr, "CSR", 0, 0x00000001},
    {0x80, "SSCGR", 0, 0xFFFFFFFF, 0xFFFFFFFF},
    {0x84, "PLLI2SCFGR", 0x20003000},
    {kPllSaiCfgr, "PLLSAICFGR", 0x24003000},
    {kDckCfgr, "DCKCFGR", 0},
    {kDckCfgr2, "DCKCFGR2", 0},
    {0x94, "DCKCFGR3", 0},
};

// CR: HSI, HSE, PLL, PLLI2S, PLLSAI
constexpr RccReady kReady[] = {{kCr, 0x15010001}, {kBdcr, 1}, {kCsr, 1}};
constexpr std::uint16_t kTree[] = {kCr, kPllCfgr, kCfgr, kPllSaiCfgr, kDckCfgr, kDckCfgr2};
constexpr RccMap kMap{.registers = kRegisters,
                      .ready = kReady,
                      .tree = kTree,
                      .cfgr = kCfgr,
                      .csr = kCsr,
                      .rmvf = 24,
                      .switches = {0, 16, 24, 24},
                      .hsi = 0,
                      .hsi_hz = 16e6};

class RccF4F7 final : public Rcc {
 public:
  RccF4F7(ChipContext& context) : Rcc(kMap, context) {}

 protected:
  double pll_hz() {
    const std::uint32_t v = value(kPllCfgr);
    const double input_hz = bit(v, 22) ? clocks().hse_hz : clocks().hsi_hz;
    const std::uint32_t m = field(v, 0, 6), n = field(v, 6, 9);
    // f(VCO) = f(in) N / M, f(PLL) = f(VCO) / P
    const double vco_hz = m == 0 ? 0.0 : input_hz * n / m;
    if ((value(kCfgr) & 3u) == 3) return vco_hz / std::max(2u, field(v, 28, 3));  // PLL_R (F446)
    return vco_hz / (2.0 * (field(v, 16, 2) + 1));
  }

  // Of the card's host: 48 MHz by PLL's Q or PLLSAI's P, or SYSCLK; 0: what it is chosen from is off.
  double card_hz() {
    const std::uint32_t v = value(kPllCfgr), sai = value(kPllSaiCfgr), choice = value(kDckCfgr2);
    if (bit(choice, 28)) return sysclk_hz();
    const bool by_sai = bit(choice, 27);
    const std::uint32_t m = field(v, 0, 6), n = by_sai ? field(sai, 6, 9) : field(v, 6, 9);
    const std::uint32_t by = by_sai ? 2 * (field(sai, 16, 2) + 1) : field(v, 24, 4);
    if (m == 0 || by == 0 || !bit(value(kCr), by_sai ? 28 : 24)) return 0.0;
    return (bit(v, 22) ? clocks().hse_hz : clocks().hsi_hz) * n / m / by;
  }

  ClockState tree() override {
    const std::uint32_t cfgr = value(kCfgr), wanted = cfgr & 3u;
    select(wanted, wanted == 1 ? clocks().hse_hz : pll_hz());
    const std::uint32_t apb1 = apb_divider(field(cfgr, 10, 3)), apb2 = apb_divider(field(cfgr, 13, 3));
    ClockState state = buses(sysclk_hz(), ahb_divider(field(cfgr, 4, 4)), apb1, apb2);
    kernel(state, Bus::kSdmmc, card_hz());
    if (bit(value(kDckCfgr), 24)) {  // TIMPRE: up to four times PCLK, at most HCLK
      state.timers[1].div = apb1 <= 4 ? 1 : apb1 / 4;
      state.timers[2].div = apb2 <= 4 ? 1 : apb2 / 4;
    }
    return state;
  }
};
}  // namespace

std::unique_ptr<Rcc> make_rcc_f4_f7(RccFamily, ChipContext& context) {
  return std::make_unique<RccF4F7>(context);
}

}  // namespace omnihil::mcu
