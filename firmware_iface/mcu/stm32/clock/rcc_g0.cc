// RCC of G0 (RM0444 §5).
#include "firmware_iface/mcu/stm32/clock/rcc.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t { kCr = 0x00, kCfgr = 0x08, kPllCfgr = 0x0C, kCcipr = 0x54, kBdcr = 0x5C, kCsr = 0x60 };

constexpr RegisterInfo kRegisters[] = {
    {kCr, "CR", 0x00000100, 0x014D3B00, 0x00080200},
    {0x04, "ICSCR", 0x00004000, 0x00007F00},
    {kCfgr, "CFGR", 0, 0xFFFF7F07, 0xFFFF0000},
    {kPllCfgr, "PLLCFGR", 0x00001000, 0xFF3F7F73},
    {0x14, "CRRCR", 0, 0},
    {0x18, "CIER", 0, 0xFFFFFFFF, 0xFFFFFFFF},
    {0x1C, "CIFR", 0, 0},
    {0x20, "CICR", 0, 0},
    {0x24, "IOPRSTR"},
    {0x28, "AHBRSTR"},
    {0x2C, "APBRSTR1"},
    {0x30, "APBRSTR2"},
    {0x34, "IOPENR"},
    {0x38, "AHBENR", 0x00000100},
    {0x3C, "APBENR1"},
    {0x40, "APBENR2"},
    {0x44, "IOPSMENR", 0x0000003F},
    {0x48, "AHBSMENR", 0x00001303},
    {0x4C, "APBSMENR1", 0xFFFFFFB7},
    {0x50, "APBSMENR2", 0x0017D801},
    {kCcipr, "CCIPR", 0, 0xFFFFFFFF, 0x3FFFFFFF},
    {0x58, "CCIPR2", 0, 0x330F, 0x330F},
    {kBdcr, "BDCR", 0, 0x0301833D, 0x00018000},
    {kCsr, "CSR", 0, 0x00000001},
};

// HSI; HSE, HSI48, PLL; LSE; LSI
constexpr RccReady kReady[] = {{kCr, 0x100, 2}, {kCr, 0x01410000}, {kBdcr, 1}, {kCsr, 1}};
constexpr std::uint16_t kTree[] = {kCr, kPllCfgr, kCfgr, kCcipr};
constexpr double kHsi16_hz = 16e6;
constexpr RccMap kMap{.registers = kRegisters,
                      .ready = kReady,
                      .tree = kTree,
                      .cfgr = kCfgr,
                      .sws = 3,
                      .csr = kCsr,
                      .rmvf = 23,
                      .switches = {8, 16, 24, -1},  // LSI and LSE are no clocks that are meant
                      .hsi = 0,
                      .hsi_hz = kHsi16_hz};

class RccG0 final : public Rcc {
 public:
  explicit RccG0(ChipContext& context) : Rcc(kMap, context) {}

 protected:
  // f(in) N / M over the divider in `bits` at `at`, where its output is on at `on`.
  double pll_hz(unsigned on, unsigned at, unsigned bits) {
    const std::uint32_t v = value(kPllCfgr), source = v & 3u;
    if (!bit(value(kCr), 24) || !bit(v, on) || source < 2) return 0.0;
    const double input_hz = source == 3 ? clocks().hse_hz : kHsi16_hz;
    return input_hz / (field(v, 4, 3) + 1) * field(v, 8, 7) / (field(v, at, bits) + 1);
  }

  ClockState tree() override {
    const std::uint32_t cfgr = value(kCfgr), wanted = cfgr & 7u;
    clocks().hsi_hz = kHsi16_hz / (1u << field(value(kCr), 11, 3));  // HSISYS
    select(wanted, wanted == 1 ? clocks().hse_hz : pll_hz(28, 29, 3));
    const std::uint32_t apb = apb_divider(field(cfgr, 12, 3));  // the one APB
    ClockState state = buses(sysclk_hz(), ahb_divider(field(cfgr, 8, 4)), apb, apb);
    const unsigned adc = field(value(kCcipr), 30, 2);
    kernel(state, Bus::kAdc,
           adc == 0   ? sysclk_hz()
           : adc == 1 ? pll_hz(16, 17, 5)
           : adc == 2 ? kHsi16_hz
                      : 0.0);
    return state;
  }
};
}  // namespace

std::unique_ptr<Rcc> make_rcc_g0(ChipContext& context) { return std::make_unique<RccG0>(context); }

}  // namespace omnihil::mcu
