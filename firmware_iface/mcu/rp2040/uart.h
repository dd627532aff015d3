// UART0 and UART1 of the RP2040, ARM's PL011.
//
//   RpUart uart(0, 20, context);
//   uart.baud();                     // clk_peri / (16 (IBRD + FBRD / 64))
//
// Law: RP2040 datasheet §4.2, ARM DDI 0183G: FIFOs of 32 with their levels, receive time-out of 32 bit times, DMA requests.
// Parity is made and stripped, not checked. Cannot represent: framing errors, break, flow control, IrDA, loop-back.
#pragma once
#include <deque>

#include "firmware_iface/mcu/rp2040/rp2040_block.h"
#include "firmware_iface/mcu/stm32/serial_port.h"

namespace omnihil::mcu::rp2040 {

class RpUart final : public Rp2040Block, public SerialPort {
 public:
  RpUart(unsigned number, int irq, ChipContext& context);
  void reset() override;
  void run_events() override;
  void clock_changed() override;
  Cycles stable_until(std::uint32_t offset) const override { return (offset & 0xFFCu) == 0 ? 0 : kNever; }

  void feed(std::span<const std::uint8_t> bytes, std::int64_t at_ns, double bit_ns = 0.0) override;
  double baud() const override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  struct Waiting {
    std::int64_t at_ns;
    std::uint8_t byte;
  };
  bool on(unsigned which) const;
  std::size_t depth() const;
  unsigned data_bits() const;
  unsigned frame_bits() const;
  Cycles bit_times(unsigned bits) const;
  void transmit(std::uint8_t byte);
  void receive(std::uint8_t byte);
  void show_frame(bool sent, std::uint8_t byte, Cycles end) const;
  void schedule();
  void levels();
  void update();
  std::uint32_t flags() const;

  ChipContext& context_;
  IrqLine irq_;
  int dma_rx_, dma_tx_;
  std::uint32_t raw_ = 0, errors_ = 0;
  bool gap_ = false;                    // a byte was lost behind the last one received
  std::deque<std::uint16_t> received_;  // with OE of the byte in bit 11
  std::deque<std::uint8_t> holding_;
  std::uint8_t shifting_ = 0;
  std::deque<Waiting> waiting_;
  Cycles sent_at_ = kNever, comes_at_ = kNever, timeout_at_ = kNever, next_ = kNever;
};

}  // namespace omnihil::mcu::rp2040
