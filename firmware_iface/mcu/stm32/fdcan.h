// FDCAN (G4): frames in a message RAM of fixed layout, filters, two receive FIFOs, transmit FIFO or queue.
//
//   FdcanRam ram;                                            // 0x4000A400, shared by the three
//   Fdcan can(1, {21, 22}, ram, context);
//
// Law: RM0440 §44. Classic and FD frames; bit time (NBRP + 1)(3 + NTSEG1 + NTSEG2) of PCLK1, data phase by
// DBTP. Cannot represent: what can.h says; time stamps, transmit events, high-priority messages, restricted
// operation.
#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/can.h"
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

class FdcanRam final : public Peripheral {
 public:
  static constexpr std::uint32_t kBytes = 3 * 0x350;  // of G4: one part each
  explicit FdcanRam(std::uint32_t bytes = kBytes) : Peripheral("FDCAN message RAM"), bytes_(bytes, 0) {}
  void reset() override {}
  std::uint32_t read(std::uint32_t offset, unsigned bytes) override;
  void write(std::uint32_t offset, unsigned bytes, std::uint32_t value) override;
  std::uint32_t peek(std::uint32_t offset) override { return read(offset, 4); }
  std::uint32_t word(std::uint32_t offset) { return read(offset, 4); }

 private:
  std::vector<std::uint8_t> bytes_;
};

class Fdcan final : public RegisterBlock, public CanPort {
 public:
  Fdcan(int number, std::pair<int, int> irqs, FdcanRam& ram, ChipContext& context);
  void reset() override;
  void run_events() override;

 protected:
  void take(const CanFrame& frame) override;
  double bit_cycles() const override;
  Cycles present() const override { return now(); }
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  struct Fifo {
    unsigned get = 0, fill = 0;
    bool lost = false;
  };
  bool running() const { return (value(0x18) & 1u) == 0; }
  std::uint32_t element(unsigned fifo, unsigned place) const {
    return base_ + (fifo == 0 ? 0xB0u : 0x188u) + 72 * place;
  }
  CanFrame buffer(unsigned place) const;
  double bit_clocks() const;
  int filter(const CanFrame& frame, unsigned& index) const;  // FIFO, or -1
  void transmit_next();
  void update();

  ChipContext& context_;
  FdcanRam& ram_;
  std::uint32_t base_;
  std::array<Fifo, 2> fifos_;
  std::vector<unsigned> asked_;  // buffers waiting, in the order of the requests
  Cycles sent_at_ = kNever;
  IrqLine irq0_, irq1_;
};

}  // namespace omnihil::mcu
