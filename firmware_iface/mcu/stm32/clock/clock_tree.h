// What frequencies the buses of a chip have, as ratios to the core clock, which is AHB's on all but H7.
//
//   tree.timers(Bus::kApb1);     // {1, 2}: one timer tick per two core cycles
//   tree.listen(timer);          // its clock_changed() is called at every change, with the new ratios in place
//
// Set by the RCC of the chip alone. Law: an APB timer runs at PCLK where the APB prescaler is 1, else at
// twice PCLK (RM0090 §7.2, RM0316 §9.2). Cannot represent: start-up times of oscillators and PLLs (ready at
// once).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

// Buses, then kernel clocks: what blocks run from on chips that let them choose.
enum class Bus : std::uint8_t {
  kAhb,
  kApb1,
  kApb2,
  kApb3,
  kApb4,
  kAdc,
  kUsart16,
  kUsartRest,
  kLowPowerUart,
  kSpi123,
  kSpi45,
  kSpi6,
  kI2c123,
  kI2c4,
  kFdcan,
  kSdmmc,
  kReference,  // RP2040: clk_ref, clk_peri
  kPeripheral,
  kEnd
};
inline constexpr std::size_t kBuses = static_cast<std::size_t>(Bus::kEnd);

struct ClockRatio {  // ticks per core cycle
  std::uint32_t mul = 1, div = 1;
  bool operator==(const ClockRatio&) const = default;
};

struct ClockState {
  double sysclk_hz = 8e6;
  double hclk_hz = 8e6;  // of the core
  std::array<ClockRatio, kBuses> bus{};
  std::array<ClockRatio, 3> timers{};  // of the timers on that bus
  ClockRatio fast_timers{};            // of TIM1, TIM8, … where the chip can feed them from twice the PLL
  bool fast_timers_on = false;
  std::uint32_t off =
      0;  // a bit per bus: a kernel clock that was chosen and does not run; the bus's is taken
  ClockRatio& of(Bus which) { return bus[static_cast<std::size_t>(which)]; }
};

class ClockTree {
 public:
  explicit ClockTree(System& system) : system_(system) {}
  double hse_hz = 8e6;   // the board's crystal
  double hsi_hz = 16e6;  // set by the chip
  double lsi_hz = 32e3;  // set by the chip
  double lse_hz = 32768;

  const ClockState& state() const { return state_; }
  ClockRatio bus(Bus bus) const { return state_.bus[static_cast<std::size_t>(bus)]; }
  ClockRatio timers(Bus bus) const { return state_.timers[static_cast<std::size_t>(bus)]; }
  double bus_hz(Bus at) const { return state_.hclk_hz * bus(at).mul / bus(at).div; }
  // Said by a block that is switched on: its clock had better run.
  void need(Bus at, std::string_view block) const {
    if ((state_.off >> static_cast<unsigned>(at) & 1u) != 0)
      system_.report_unmodelled(block, "its kernel clock is off; that of its bus is taken");
  }
  void listen(Peripheral& peripheral) { listeners_.push_back(&peripheral); }
  void set(const ClockState& state) {
    state_ = state;
    system_.set_core_hz(state.hclk_hz);
    for (Peripheral* p : listeners_) p->clock_changed();
  }

 private:
  System& system_;
  ClockState state_;
  std::vector<Peripheral*> listeners_;
};

}  // namespace omnihil::mcu
