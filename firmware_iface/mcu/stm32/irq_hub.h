// Interrupt lines that several peripherals share: high while any of them asks.
//
//   IrqHub hub(system);
//   IrqLine line(hub, 18);
//   line.set(true);        // system.set_irq(18, true)
#pragma once
#include <vector>

#include "firmware_iface/mcu/peripheral.h"

namespace omnihil::mcu {

class IrqHub {
 public:
  explicit IrqHub(System& system) : system_(system) {}
  void change(int irq, bool high) {
    const auto i = static_cast<std::size_t>(irq);
    if (asking_.size() <= i) asking_.resize(i + 1, 0);
    asking_[i] += high ? 1 : -1;
    if (high ? asking_[i] == 1 : asking_[i] == 0) system_.set_irq(irq, high);
  }

 private:
  System& system_;
  std::vector<int> asking_;  // by interrupt: how many lines are high
};

class IrqLine {
 public:
  IrqLine(IrqHub& hub, int irq) : hub_(&hub), irq_(irq) {}  // below 0: not connected
  void set(bool high) {
    if (high == high_ || irq_ < 0) return;
    high_ = high;
    hub_->change(irq_, high);
  }
  bool high() const { return high_; }

 private:
  IrqHub* hub_;
  int irq_;
  bool high_ = false;
};

}  // namespace omnihil::mcu
