// What frequencies the buses of a chip have, as ratios to the core clock, which is AHB's.
//
//   tree.timers(Bus::kApb1);     // {1, 2}: one timer tick per two core cycles
//   tree.listen(timer);          // its clock_changed() is called at every change, with the new ratios in place
//
// Set by the RCC of the chip alone. Law: an APB timer runs at PCLK where the APB prescaler is 1, else at
// twice PCLK (RM0090 §7.2, RM0316 §9.2). Cannot represent: start-up times of oscillators and PLLs (ready at
// once).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

enum class Bus : std::uint8_t { kAhb, kApb1, kApb2 };

struct ClockRatio {  // ticks per core cycle
  std::uint32_t mul = 1, div = 1;
  bool operator==(const ClockRatio&) const = default;
};

struct ClockState {
  double sysclk_hz = 8e6;
  double hclk_hz = 8e6;
  std::array<ClockRatio, 3> bus{};     // AHB, APB1, APB2
  std::array<ClockRatio, 3> timers{};  // of the timers on that bus
  ClockRatio fast_timers{};            // of TIM1, TIM8, … where the chip can feed them from twice the PLL
  bool fast_timers_on = false;
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
