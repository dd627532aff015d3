// CORDIC unit of G4 and H7 (RM0440 §17): ten functions of one or two numbers between -1 and 1.
//
//   Cordic cordic(context, 100);                               // its interrupt
//   CordicPair p = cordic_function(0, 0, 24, 0.25, 1.0);       // cosine and sine of a quarter of pi
//
// Law: four iterations a cycle, PRECISION cycles a result; each of them halves what the last one left of the angle. Worked
// out as those iterations are, in double, and cut to the 32 or 16 bits of the result; the unit's own words have a few bits
// more than the result and end near 2^-19 whatever the number of iterations, which the cut to 20 binary places stands for.
// A result that is read before it is there is read as if it were (the bus would wait). Cannot represent: that wait, the
// rounding of single bits.
#pragma once
#include <array>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

class Cordic final : public RegisterBlock {
 public:
  Cordic(ChipContext& context, int irq);
  void reset() override;
  void run_events() override;
  Cycles stable_until(std::uint32_t) const override { return 0; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  void begin();
  void update();

  ChipContext& context_;
  IrqLine irq_;
  int dma_read_, dma_write_;
  std::array<std::uint32_t, 2> arguments_{}, results_{};
  unsigned written_ = 0, read_ = 0;  // of a pair
  bool pending_ = false, ready_ = false;
  Cycles done_ = kNever;
};

// The iterations alone; numbers as the registers have them (between -1 and 1, scaled). For tests, too.
struct CordicPair {
  double first = 0.0, second = 0.0;
};
CordicPair cordic_function(unsigned function, unsigned scale, unsigned iterations, double first,
                           double second);

}  // namespace omnihil::mcu
