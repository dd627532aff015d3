// PIO0 and PIO1 of the RP2040: four state machines each over 32 words of program.
//
//   Pio pio(0, io, context);
//
// Law: RP2040 datasheet §3. Each machine's instructions run at their own instants, with the fraction of its clock divider.
// A machine that does nothing outside but fill its FIFO is run when somebody looks, or a pin changes; one that comes round
// to the same state with nothing changed is asleep until something does. Pins are seen at once: the two cycles of their
// synchronizers are left out.
#pragma once
#include <array>

#include "firmware_iface/mcu/rp2040/io_bank.h"
#include "firmware_iface/mcu/rp2040/pio_machine.h"

namespace omnihil::mcu::rp2040 {

class Pio final : public Rp2040Block {
 public:
  Pio(unsigned number, IoBank& io, ChipContext& context);
  void reset() override;
  void run_events() override;
  Cycles stable_until(std::uint32_t) const override { return 0; }
  // By DMA: a channel waits for this machine's FIFO.
  void want(unsigned machine, bool receives, bool wanted);

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  static constexpr unsigned kMachines = 4;
  using Time = std::uint64_t;  // 256ths of a cycle of the core
  struct Seen {                // where it was before, to find that it comes round
    StateMachine::State state;
    Time at = 0;
    unsigned left = 0;  // looks until another place is remembered
  };
  struct Runner {
    StateMachine sm;
    Time at = 0;  // of its next instruction
    bool asleep = false, outside = false;
    Time turn = 0;  // of the loop that it sleeps in
    Seen seen;
  };
  void advance();
  void run(Runner& runner);
  void look_round(Runner& runner, unsigned pc_before, bool stalled);
  void wake();
  void drive();
  void input_changed();
  void plan();
  void settle();
  void update();
  std::uint32_t raw() const;
  std::uint32_t fifo_status() const;
  void store_machine(unsigned machine, std::uint32_t offset, std::uint32_t written, std::uint32_t lanes);
  void control(std::uint32_t written);

  unsigned number_;
  IoBank& io_;
  ChipContext& context_;
  std::array<std::uint16_t, 32> program_{};
  std::array<Runner, kMachines> runners_;
  PioPort port_;
  std::uint32_t debug_ = 0;   // FDEBUG but for the machines' own
  std::uint32_t wanted_ = 0;  // by DMA: TX, RX
  bool advancing_ = false;
  std::array<int, 2 * kMachines> requests_{};
  IrqLine first_, second_;
  Cycles next_ = kNever;
};

}  // namespace omnihil::mcu::rp2040
