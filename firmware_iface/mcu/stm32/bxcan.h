// bxCAN (F3, F4, F7): three transmit mailboxes, two receive FIFOs of three, filter banks.
//
//   BxCan can("CAN1", {19, 20, 21, 22}, 28, nullptr, context);        // its own filters
//   BxCan second("CAN2", {63, 64, 65, 66}, 0, &can, context);         // those of CAN1 from CAN2SB on
//
// Law: RM0090 §32. INAK follows INRQ at once even while SLEEP is set. Frames that pass no active filter are
// dropped. Cannot represent: what can.h says; time-triggered mode, test mode other than loop-back.
#pragma once
#include <array>
#include <deque>
#include <string>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

class BxCan final : public RegisterBlock, public CanPort {
 public:
  BxCan(const std::string& name, std::array<int, 4> irqs, unsigned banks, BxCan* filters,
        ChipContext& context);
  void reset() override;
  void run_events() override;

 protected:
  void take(const CanFrame& frame) override;
  double bit_cycles() const override;
  Cycles present() const override { return now(); }
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  struct Received {
    CanFrame frame;
    unsigned filter;
  };
  bool running() const { return (value(0x04) & 3u) == 0; }
  CanFrame mailbox(unsigned m) const;
  Cycles bit_clocks() const;
  void transmit_next();
  void complete(unsigned m, bool ok);
  // The FIFO and filter number that take a frame; -1: none.
  int match(const CanFrame& frame, unsigned first, unsigned last, unsigned& number) const;
  bool passes(unsigned bank, const CanFrame& frame, unsigned& number, unsigned fifo_numbers[2]) const;
  void show(unsigned fifo);
  void update();

  ChipContext& context_;
  const BxCan* second_ = nullptr;  // that shares its filters
  BxCan* filters_;
  unsigned banks_;
  std::array<std::deque<Received>, 2> fifos_;
  std::array<std::uint64_t, 3> asked_{};  // order of the requests
  std::uint64_t requests_ = 0;
  int sending_ = -1;
  Cycles sent_at_ = kNever;
  IrqLine irq_tx_, irq_rx0_, irq_rx1_, irq_sce_;
};

}  // namespace omnihil::mcu
