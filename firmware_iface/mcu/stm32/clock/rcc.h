// Reset and clock control: from the registers of a family to the frequencies of the buses.
//
//   auto rcc = make_rcc(RccFamily::kF4, context);     // writes context.clocks at every change
//
// Law: the clock trees of RM0091 (F0), RM0008 (F1), RM0316 (F3), RM0090 (F4), RM0410 (F7), RM0444 (G0), RM0440 (G4), RM0433 (H7) and
// RM0351 (L4), an internal oscillator or HSE or PLL to SYSCLK, prescalers to HCLK and PCLKx. Oscillators and PLLs are ready
// at once after they are switched on. A PLL whose input is off, or a selected source that is not ready, is reported and the
// switch does not happen. Enable and reset bits of peripherals are kept; a peripheral works whether it is enabled or not (not
// modelled), kernel clocks other than PCLK and SYSCLK for U(S)ARTs are reported; those of H7 are followed. Clock outputs
// and the RTC are not modelled.
#pragma once
#include <array>
#include <memory>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

enum class RccFamily { kF0, kF1, kF3, kF4, kF7, kG0, kG4, kH7, kL4 };

// Ready bits that follow their switches at once: those of `switches`, `up` places further.
struct RccReady {
  std::uint16_t offset = 0;
  std::uint32_t switches = 0;
  unsigned up = 1;
};

// Bits of the status register that say why the chip was reset; as RM0090's CSR has them.
struct RccReasons {
  std::uint32_t power = 1u << 27, pin = 1u << 26, software = 1u << 28, iwdg = 1u << 29, wwdg = 1u << 30;
};

// What a family's registers mean, by its reference manual.
struct RccMap {
  std::span<const RegisterInfo> registers;
  std::span<const RccReady> ready;
  std::span<const std::uint16_t> tree;  // a write to one of them asks for another clock tree
  std::uint16_t cfgr = 0;               // SW from bit 0 on
  unsigned sws = 2;                     // where SWS begins in it
  std::uint16_t csr = 0;                // with the reset flags
  unsigned rmvf = 0;                    // CSR's bit that clears them
  RccReasons reasons{};
  std::array<int, 4> switches{0, 16, 24,
                              -1};  // CR's bit of each source by its code of SW; below 0: there is none
  std::uint32_t hsi = 0;            // the code of SW for the internal oscillator, the source after a reset
  double hsi_hz = 0.0;
};

class Rcc : public RegisterBlock {
 public:
  Rcc(const RccMap& map, ChipContext& context)
      : RegisterBlock("RCC", context.system, map.registers),
        map_(map),
        selected_(map.hsi),
        sysclk_hz_(map.hsi_hz),
        context_(context) {
    context.clocks.hsi_hz = map.hsi_hz;
  }
  void reset() override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;
  // The tree that the registers ask for now.
  virtual ClockState tree() = 0;
  ClockTree& clocks() { return context_.clocks; }

  static std::uint32_t ahb_divider(std::uint32_t code);  // HPRE
  static std::uint32_t apb_divider(std::uint32_t code);  // PPREx
  // A frequency as a ratio to the core's.
  static ClockRatio ratio(double hz, double core_hz);
  // Fills in HCLK, APB buses and their timers.
  static ClockState buses(double sysclk_hz, std::uint32_t ahb, std::uint32_t apb1, std::uint32_t apb2);
  // A kernel clock; of no frequency: off, its bus's is taken (its block says so).
  static void kernel(ClockState& state, Bus which, double hz);
  // Makes `wanted` (the code of SW) the system clock of `hz` if that source is on; if not, what was stays and
  // it is reported.
  void select(std::uint32_t wanted, double hz);
  // CFGR's SWS: the source in use.
  std::uint32_t selected() const { return selected_; }
  double sysclk_hz() const { return sysclk_hz_; }

 private:
  std::uint32_t reset_flags() const;
  void apply() { context_.clocks.set(tree()); }

  RccMap map_;
  bool flags_cleared_ = false;
  std::uint32_t selected_;
  double sysclk_hz_;
  ChipContext& context_;
};

std::unique_ptr<Rcc> make_rcc(RccFamily family, ChipContext& context);
std::unique_ptr<Rcc> make_rcc_f0_f3(RccFamily family, ChipContext& context);
std::unique_ptr<Rcc> make_rcc_f1(ChipContext& context);
std::unique_ptr<Rcc> make_rcc_f4_f7(RccFamily family, ChipContext& context);
std::unique_ptr<Rcc> make_rcc_g0(ChipContext& context);
std::unique_ptr<Rcc> make_rcc_g4(ChipContext& context);
std::unique_ptr<Rcc> make_rcc_h7(ChipContext& context);
std::unique_ptr<Rcc> make_rcc_l4(ChipContext& context);

}  // namespace omnihil::mcu
