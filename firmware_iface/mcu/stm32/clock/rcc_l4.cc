// RCC of L4 (RM0351 §6).
#include "firmware_iface/mcu/stm32/clock/rcc.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kCr = 0x00,
  kCfgr = 0x08,
  kPllCfgr = 0x0C,
  kSai1Cfgr = 0x10,
  kSai2Cfgr = 0x14,
  kCcipr = 0x88,
  kBdcr = 0x90,
  kCsr = 0x94,
  kCrrcr = 0x98
};

constexpr RegisterInfo kRegisters[] = {
    {kCr, "CR", 0x00000061, 0x150D0BFD, 0x00080800},
    {0x04, "ICSCR", 0x10000000, 0x1F00FF00},
    {kCfgr, "CFGR", 0, 0x7F00BFF3, 0x7F000000},
    {kPllCfgr, "PLLCFGR", 0x00001000, 0xFF737F73},
    {kSai1Cfgr, "PLLSAI1CFGR", 0x00001000, 0xFF737F00},
    {kSai2Cfgr, "PLLSAI2CFGR", 0x00001000, 0x07037F00},
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
    {0x58, "APB1ENR1"},
    {0x5C, "APB1ENR2"},
    {0x60, "APB2ENR"},
    {0x68, "AHB1SMENR", 0x00011303},
    {0x6C, "AHB2SMENR", 0x000532FF},
    {0x70, "AHB3SMENR", 0x00000101},
    {0x78, "APB1SMENR1", 0xF2FECA3F},
    {0x7C, "APB1SMENR2", 0x00000025},
    {0x80, "APB2SMENR", 0x01677C01},
    {kCcipr, "CCIPR", 0, 0xFFFFFFFF, 0xC3FFFFFF},
    {kBdcr, "BDCR", 0, 0x0301837D, 0x00018000},
    {kCsr, "CSR", 0x00000600, 0x00000F01},
    {kCrrcr, "CRRCR", 0, 0x00000001},
    {0x9C, "CCIPR2"},
};

// MSI; HSI; HSE, PLL, PLLSAI1, PLLSAI2; LSE; HSI48; LSI
constexpr RccReady kReady[] = {{kCr, 0x1}, {kCr, 0x100, 2}, {kCr, 0x15010000},
                               {kBdcr, 1}, {kCrrcr, 1},     {kCsr, 1}};
constexpr std::uint16_t kTree[] = {kCr, kPllCfgr, kCfgr, kSai1Cfgr, kSai2Cfgr, kCcipr, kCsr};
constexpr RccMap kMap{.registers = kRegisters,
                      .ready = kReady,
                      .tree = kTree,
                      .cfgr = kCfgr,
                      .csr = kCsr,
                      .rmvf = 23,
                      .switches = {0, 8, 16, 24},
                      .hsi = 0,  // the MSI
                      .hsi_hz = 4e6};
constexpr double kHsi16_hz = 16e6;

class RccL4 final : public Rcc {
 public:
  explicit RccL4(ChipContext& context) : Rcc(kMap, context) {}

 protected:
  // MSI's ranges; from CR with MSIRGSEL, else as after standby from CSR.
  double msi_hz() const {
    constexpr double kRanges[] = {1e5, 2e5, 4e5, 8e5, 1e6, 2e6, 4e6, 8e6, 16e6, 24e6, 32e6, 48e6};
    const unsigned range = bit(value(kCr), 3) ? field(value(kCr), 4, 4) : field(value(kCsr), 8, 4);
    return kRanges[range < 12 ? range : 11];
  }
  // f(VCO) = f(in) N / M, of a PLL by its configuration register; output by a divider at `at`, of 2, 4, 6, 8.
  double pll_hz(std::uint16_t reg, unsigned on, unsigned at) {
    const std::uint32_t v = value(kPllCfgr), own = value(reg), source = v & 3u;
    if (!bit(value(kCr), on) || source == 0) return 0.0;
    const double input_hz = source == 1 ? msi_hz() : source == 2 ? kHsi16_hz : clocks().hse_hz;
    return input_hz / (field(v, 4, 3) + 1) * field(own, 8, 7) / (2.0 * (field(own, at, 2) + 1));
  }

  ClockState tree() override {
    const std::uint32_t cfgr = value(kCfgr), wanted = cfgr & 3u;
    clocks().hsi_hz = msi_hz();
    const double hz = wanted == 1 ? kHsi16_hz : wanted == 2 ? clocks().hse_hz : pll_hz(kPllCfgr, 24, 25);
    select(wanted, hz);
    ClockState state = buses(sysclk_hz(), ahb_divider(field(cfgr, 4, 4)), apb_divider(field(cfgr, 8, 3)),
                             apb_divider(field(cfgr, 11, 3)));
    const unsigned card = field(value(kCcipr), 26, 2), adc = field(value(kCcipr), 28, 2);
    kernel(state, Bus::kSdmmc,
           card == 1   ? pll_hz(kSai1Cfgr, 26, 21)
           : card == 2 ? pll_hz(kPllCfgr, 24, 21)
           : card == 3 ? msi_hz()
                       : 0.0);
    kernel(state, Bus::kAdc,
           adc == 1   ? pll_hz(kSai1Cfgr, 26, 25)
           : adc == 2 ? pll_hz(kSai2Cfgr, 28, 25)
           : adc == 3 ? sysclk_hz()
                      : 0.0);
    return state;
  }
};
}  // namespace

std::unique_ptr<Rcc> make_rcc_l4(ChipContext& context) { return std::make_unique<RccL4>(context); }

}  // namespace omnihil::mcu
