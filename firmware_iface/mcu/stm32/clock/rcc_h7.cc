// RCC of H7, single core (RM0433 §8; RM0468 §8).
#include <array>

#include "firmware_iface/mcu/stm32/clock/rcc.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kCr = 0x00,
  kCfgr = 0x10,
  kD1Cfgr = 0x18,
  kD2Cfgr = 0x1C,
  kD3Cfgr = 0x20,
  kPllCkSelr = 0x28,
  kPllCfgr = 0x2C,
  kPllDivr = 0x30,  // of PLL1; 8 further each
  kPllFracr = 0x34,
  kD1Ccipr = 0x4C,
  kD2Ccip1r = 0x50,
  kD2Ccip2r = 0x54,
  kD3Ccipr = 0x58,
  kBdcr = 0x70,
  kCsr = 0x74,
  kRsr = 0xD0,
  kCore1 = 0x130  // the registers from RSR on once more, for the core that asks
};

// Clocks without an effect: MCO, HRTIM's, security system, RTC's. Enable and reset bits as in other families.
constexpr RegisterInfo kRegisters[] = {
    {kCr, "CR", 0x00000001, 0x150F12BB, 0x000C0000},
    {0x04, "HSICFGR", 0x40000000, 0x7F000000},
    {0x08, "CRRCR", 0, 0},
    {0x0C, "CSICFGR", 0x20000000, 0x3F000000},
    {kCfgr, "CFGR", 0, 0xFFFCFFC7, 0xFFFC4000},
    {kD1Cfgr, "D1CFGR", 0, 0xF7F},
    {kD2Cfgr, "D2CFGR", 0, 0x770},
    {kD3Cfgr, "D3CFGR", 0, 0x70},
    {kPllCkSelr, "PLLCKSELR", 0x02020200, 0x03F3F3F3},
    {kPllCfgr, "PLLCFGR", 0x01FF0000, 0x01FF0FFF},
    {0x30, "PLL1DIVR", 0x01010280, 0x7F7FFFFF},
    {0x34, "PLL1FRACR", 0, 0xFFF8},
    {0x38, "PLL2DIVR", 0x01010280, 0x7F7FFFFF},
    {0x3C, "PLL2FRACR", 0, 0xFFF8},
    {0x40, "PLL3DIVR", 0x01010280, 0x7F7FFFFF},
    {0x44, "PLL3FRACR", 0, 0xFFF8},
    {kD1Ccipr, "D1CCIPR"},
    {kD2Ccip1r, "D2CCIP1R"},
    {kD2Ccip2r, "D2CCIP2R"},
    {kD3Ccipr, "D3CCIPR"},
    {0x60, "CIER", 0, 0x3FF, 0x3FF},
    {0x64, "CIFR", 0, 0},
    {0x68, "CICR", 0, 0},
    {kBdcr, "BDCR", 0, 0x0001837D, 0x00018000},
    {kCsr, "CSR", 0, 0x00000001},
    {0x7C, "AHB3RSTR"},
    {0x80, "AHB1RSTR"},
    {0x84, "AHB2RSTR"},
    {0x88, "AHB4RSTR"},
    {0x8C, "APB3RSTR"},
    {0x90, "APB1LRSTR"},
    {0x94, "APB1HRSTR"},
    {0x98, "APB2RSTR"},
    {0x9C, "APB4RSTR"},
    {0xA0, "GCR", 0, 0xF},
    {0xA8, "D3AMR"},
    {kRsr, "RSR", 0, 0},
    {0xD4, "AHB3ENR"},
    {0xD8, "AHB1ENR"},
    {0xDC, "AHB2ENR"},
    {0xE0, "AHB4ENR"},
    {0xE4, "APB3ENR"},
    {0xE8, "APB1LENR"},
    {0xEC, "APB1HENR"},
    {0xF0, "APB2ENR"},
    {0xF4, "APB4ENR", 0x00010000},
    {0xFC, "AHB3LPENR", 0xFFFFFFFF},
    {0x100, "AHB1LPENR", 0xFFFFFFFF},
    {0x104, "AHB2LPENR", 0xFFFFFFFF},
    {0x108, "AHB4LPENR", 0xFFFFFFFF},
    {0x10C, "APB3LPENR", 0xFFFFFFFF},
    {0x110, "APB1LLPENR", 0xFFFFFFFF},
    {0x114, "APB1HLPENR", 0xFFFFFFFF},
    {0x118, "APB2LPENR", 0xFFFFFFFF},
    {0x11C, "APB4LPENR", 0xFFFFFFFF},
    {0x130, "C1_RSR", 0, 0},
    {0x134, "C1_AHB3ENR"},
    {0x138, "C1_AHB1ENR"},
    {0x13C, "C1_AHB2ENR"},
    {0x140, "C1_AHB4ENR"},
    {0x144, "C1_APB3ENR"},
    {0x148, "C1_APB1LENR"},
    {0x14C, "C1_APB1HENR"},
    {0x150, "C1_APB2ENR"},
    {0x154, "C1_APB4ENR"},
};

// HSI; CSI, HSI48, HSE, PLL1 to PLL3; LSE; LSI
constexpr RccReady kReady[] = {{kCr, 0x1, 2}, {kCr, 0x15011080}, {kBdcr, 1}, {kCsr, 1}};
constexpr std::uint16_t kTree[] = {kCr,      kCfgr,    kD1Cfgr,   kD2Cfgr,   kD3Cfgr, kPllCkSelr,
                                   kPllCfgr, 0x30,     0x34,      0x38,      0x3C,    0x40,
                                   0x44,     kD1Ccipr, kD2Ccip1r, kD2Ccip2r, kD3Ccipr};
constexpr RccMap kMap{.registers = kRegisters,
                      .ready = kReady,
                      .tree = kTree,
                      .cfgr = kCfgr,
                      .sws = 3,
                      .csr = kRsr,
                      .rmvf = 16,
                      // POR and brown-out, pin, software, IWDG1, WWDG1 (RM0433 8.7.40)
                      .reasons = {1u << 23 | 1u << 21, 1u << 22, 1u << 24, 1u << 26, 1u << 28},
                      .switches = {0, 7, 16, 24},
                      .hsi = 0,
                      .hsi_hz = 64e6};
constexpr double kCsi_hz = 4e6;
constexpr double kOff = 0.0;

class RccH7 final : public Rcc {
 public:
  explicit RccH7(ChipContext& context) : Rcc(kMap, context) {}

 protected:
  std::uint32_t load(std::uint32_t offset) override {
    constexpr std::uint32_t kAlways = 1u << 5 | 1u << 14 | 1u << 15;  // HSIDIVF, D1CKRDY, D2CKRDY
    if (offset == kCore1) return Rcc::load(kRsr);
    return Rcc::load(offset) | (offset == kCr ? kAlways : 0u);
  }
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override {
    // The core's own view of RSR and of the enable registers is the same words.
    const bool own = offset >= kCore1 && offset <= 0x154;
    Rcc::store(own ? offset - kCore1 + kRsr : offset, written, lanes);
    if (own) keep(offset, written, lanes);
  }

  double hsi_hz() const { return 64e6 / (1u << field(value(kCr), 3, 2)); }
  double hse_hz() { return bit(value(kCr), 16) ? clocks().hse_hz : kOff; }
  double per_hz() {  // per_ck
    const std::array<double, 4> from{hsi_hz(), kCsi_hz, hse_hz(), kOff};
    return from[field(value(kD1Ccipr), 28, 2)];
  }
  // Output 0 P, 1 Q, 2 R of PLL `n` from 1; 0 where it is off. f(VCO) = f(ref) / M (N + FRACN / 8192)
  double pll_hz(unsigned n, unsigned output) {
    const unsigned i = n - 1;
    const std::uint32_t select = value(kPllCkSelr), config = value(kPllCfgr), divr = value(kPllDivr + 8 * i);
    if (!bit(value(kCr), 24 + 2 * i) || !bit(config, 16 + 3 * i + output)) return kOff;
    const std::array<double, 4> from{hsi_hz(), kCsi_hz, hse_hz(), kOff};
    const unsigned m = field(select, 4 + 8 * i, 6);
    if (m == 0) return kOff;
    const double fraction = bit(config, 4 * i) ? field(value(kPllFracr + 8 * i), 3, 13) / 8192.0 : 0.0;
    const double vco_hz = from[select & 3u] / m * (field(divr, 0, 9) + 1 + fraction);
    return vco_hz / (field(divr, output == 0 ? 9 : output == 1 ? 16 : 24, 7) + 1);
  }
  double lse_hz() { return bit(value(kBdcr), 0) ? clocks().lse_hz : kOff; }

  ClockState tree() override {
    const std::uint32_t wanted = value(kCfgr) & 7u;
    const std::array<double, 4> sources{hsi_hz(), kCsi_hz, hse_hz(), pll_hz(1, 0)};
    clocks().hsi_hz = hsi_hz();
    select(wanted, sources[wanted & 3u]);
    const std::uint32_t d1 = value(kD1Cfgr), d2 = value(kD2Cfgr), d3 = value(kD3Cfgr);
    const std::uint32_t ahb = ahb_divider(field(d1, 0, 4));
    const std::uint32_t apb1 = apb_divider(field(d2, 4, 3)), apb2 = apb_divider(field(d2, 8, 3));
    ClockState state;
    state.sysclk_hz = sysclk_hz();
    state.hclk_hz = sysclk_hz() / ahb_divider(field(d1, 8, 4));  // the core's, by D1CPRE
    state.of(Bus::kAhb) = {1, ahb};
    state.of(Bus::kApb1) = {1, ahb * apb1};
    state.of(Bus::kApb2) = {1, ahb * apb2};
    state.of(Bus::kApb3) = {1, ahb * apb_divider(field(d1, 4, 3))};
    state.of(Bus::kApb4) = {1, ahb * apb_divider(field(d3, 4, 3))};
    // Timers: HCLK up to a divider of 2, or with TIMPRE of 4; else twice, or four times, the bus
    const std::uint32_t most = bit(value(kCfgr), 15) ? 4 : 2;
    const auto timers = [&](std::uint32_t apb) {
      return ClockRatio{1, ahb * (apb <= most ? 1 : apb / most)};
    };
    state.timers = {state.of(Bus::kAhb), timers(apb1), timers(apb2)};
    kernels(state);
    return state;
  }

 private:
  void kernel(ClockState& state, Bus which, Bus bus, double hz) {
    state.of(which) = state.of(bus);
    Rcc::kernel(state, which, hz);
  }
  void kernels(ClockState& state) {
    const auto hz = [&state](Bus bus) {
      const ClockRatio ratio = state.of(bus);
      return state.hclk_hz * ratio.mul / ratio.div;
    };
    const std::uint32_t one = value(kD2Ccip1r), two = value(kD2Ccip2r), d3 = value(kD3Ccipr);
    const double q2 = pll_hz(2, 1), q3 = pll_hz(3, 1), r3 = pll_hz(3, 2), hsi = hsi_hz();
    // Chosen by a field of three bits: a bus, PLL2's and PLL3's Q, HSI, CSI, LSE (serial ports) or HSE (SPI)
    const auto of_bus = [&](Bus bus, double last_hz) {
      return std::array<double, 8>{hz(bus), q2, q3, hsi, kCsi_hz, last_hz, kOff, kOff};
    };
    kernel(state, Bus::kUsart16, Bus::kApb2, of_bus(Bus::kApb2, lse_hz())[field(two, 3, 3)]);
    kernel(state, Bus::kUsartRest, Bus::kApb1, of_bus(Bus::kApb1, lse_hz())[field(two, 0, 3)]);
    kernel(state, Bus::kLowPowerUart, Bus::kApb4, of_bus(Bus::kApb4, lse_hz())[field(d3, 0, 3)]);
    kernel(state, Bus::kSpi45, Bus::kApb2, of_bus(Bus::kApb2, hse_hz())[field(one, 16, 3)]);
    kernel(state, Bus::kSpi6, Bus::kApb4, of_bus(Bus::kApb4, hse_hz())[field(d3, 28, 3)]);
    const std::array<double, 8> spi{pll_hz(1, 1), pll_hz(2, 0), pll_hz(3, 0), kOff,
                                    per_hz(),     kOff,         kOff,         kOff};
    kernel(state, Bus::kSpi123, Bus::kApb2, spi[field(one, 12, 3)]);
    const std::array<double, 4> i2c123{hz(Bus::kApb1), r3, hsi, kCsi_hz},
        i2c4{hz(Bus::kApb4), r3, hsi, kCsi_hz};
    kernel(state, Bus::kI2c123, Bus::kApb1, i2c123[field(two, 12, 2)]);
    kernel(state, Bus::kI2c4, Bus::kApb4, i2c4[field(d3, 8, 2)]);
    const std::array<double, 4> can{hse_hz(), pll_hz(1, 1), q2, kOff};
    kernel(state, Bus::kFdcan, Bus::kApb1, can[field(one, 28, 2)]);
    const std::array<double, 4> adc{pll_hz(2, 0), r3, per_hz(), kOff};
    kernel(state, Bus::kAdc, Bus::kAhb, adc[field(d3, 16, 2)]);
    kernel(state, Bus::kSdmmc, Bus::kAhb, bit(value(kD1Ccipr), 16) ? pll_hz(2, 2) : pll_hz(1, 1));
  }
};
}  // namespace

std::unique_ptr<Rcc> make_rcc_h7(ChipContext& context) { return std::make_unique<RccH7>(context); }

}  // namespace omnihil::mcu
