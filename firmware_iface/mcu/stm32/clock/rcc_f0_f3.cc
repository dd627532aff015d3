// RCC of F0 (RM0091 §6) and F3 (RM0316 §9).
#include <algorithm>

#include "firmware_iface/mcu/stm32/clock/rcc.h"

namespace omnihil::mcu {
namespace {
enum : std::uint16_t {
  kCr = 0x00,
  kCfgr = 0x04,
  kBdcr = 0x20,
  kCsr = 0x24,
  kCfgr2 = 0x2C,
  kCfgr3 = 0x30,
  kCr2 = 0x34
};

constexpr RegisterInfo kRegisters[] = {
    {kCr, "CR", 0x00000083, 0x010D00F9, 0x00080000},
    {kCfgr, "CFGR", 0, 0xFFFFFFF3, 0xFF000000},
    {0x08, "CIR", 0, 0x00003F00, 0x00003F00},
    {0x0C, "APB2RSTR", 0},
    {0x10, "APB1RSTR", 0},
    {0x14, "AHBENR", 0x00000014},
    {0x18, "APB2ENR", 0},
    {0x1C, "APB1ENR", 0},
    {kBdcr, "BDCR", 0x18, 0x0001831D, 0x00018000},
    {kCsr, "CSR", 0, 0x00000001},
    {0x28, "AHBRSTR", 0},
    {kCfgr2, "CFGR2", 0, 0x0000FFFF},
    {kCfgr3, "CFGR3", 0, 0xFFFFFFFF, 0x00FF0032},
    {kCr2, "CR2", 0x80, 0x000100FD},
};

constexpr RccReady kReady[] = {{kCr, 0x01010001}, {kCr2, 0x00010001}, {kBdcr, 1}, {kCsr, 1}};
constexpr std::uint16_t kTree[] = {kCr, kCfgr, kCfgr2, kCfgr3};
constexpr RccMap kMap{.registers = kRegisters,
                      .ready = kReady,
                      .tree = kTree,
                      .cfgr = kCfgr,
                      .csr = kCsr,
                      .rmvf = 24,
                      .hsi = 0,
                      .hsi_hz = 8e6};

class RccF0F3 final : public Rcc {
 public:
  RccF0F3(bool f3, ChipContext& context) : Rcc(kMap, context), f3_(f3) { clocks().lsi_hz = 40e3; }

 protected:
  double pll_hz() {
    const std::uint32_t cfgr = value(kCfgr);
    // PLL input: HSI / 2, or HSE over PREDIV; output: input times 2 .. 16
    const double input_hz =
        bit(cfgr, 16) ? clocks().hse_hz / (field(value(kCfgr2), 0, 4) + 1) : clocks().hsi_hz / 2;
    return input_hz * std::min(field(cfgr, 18, 4) + 2, 16u);
  }

  ClockState tree() override {
    const std::uint32_t cfgr = value(kCfgr), wanted = cfgr & 3u;
    select(wanted, wanted == 1 ? clocks().hse_hz : pll_hz());
    const std::uint32_t apb1 = apb_divider(field(cfgr, 8, 3));
    const std::uint32_t apb2 = f3_ ? apb_divider(field(cfgr, 11, 3)) : apb1;  // F0 has one APB
    const std::uint32_t ahb = ahb_divider(field(cfgr, 4, 4));
    ClockState state = buses(sysclk_hz(), ahb, apb1, apb2);
    // TIM1SW, TIM8SW: twice the PLL, where SYSCLK is the PLL and AHB is not divided (RM0316 §9.2.10)
    state.fast_timers_on = f3_ && (value(kCfgr3) & 0x300u) != 0 && selected() == 2 && ahb == 1;
    state.fast_timers = {2, 1};
    return state;
  }

 private:
  bool f3_;
};
}  // namespace

std::unique_ptr<Rcc> make_rcc_f0_f3(RccFamily family, ChipContext& context) {
  return std::make_unique<RccF0F3>(family == RccFamily::kF3, context);
}

}  // namespace omnihil::mcu
