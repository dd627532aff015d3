// A serial port: v1 (F4) and v2 (F0, F3, F7, G4) registers over one law.
//
//   Usart usart({.number = 1, .v2 = false, .bus = Bus::kApb2, .irq = 37}, context);
//   usart.on_transmit([](std::uint8_t byte, Cycles end) { … });   // when its stop bit has left
//   usart.feed(bytes, at_ns);                        // from the other end, one frame after the other
//
// Law: RM0090 §30, RM0316 §29; LPUART and FIFOs: RM0440 §37, §38. A frame takes start + data + stop bits of BRR
// clock periods each; a received byte is there at the end of its frame; the line is idle one frame after the
// last. Both ends are assumed to agree on the baud rate unless `feed` says what the other end's bit takes. Parity
// is made and stripped, not checked. Cannot represent: framing errors, noise, break, LIN, smart card, IrDA,
// synchronous mode, flow control, mute, receiver timeout.
#pragma once
#include <deque>
#include <span>
#include <string>
#include <utility>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"
#include "firmware_iface/mcu/stm32/serial_port.h"

namespace omnihil::mcu {

struct UsartSpec {
  int number = 1;
  std::string name = "USART1";
  bool v2 = false;
  Bus bus = Bus::kApb2;
  int irq = -1;
  bool low_power = false;  // LPUART: BRR counts 256ths of a clock period
  unsigned fifo = 0;       // how many bytes its FIFOs hold; 0: it has none, and no prescaler
};

class Usart final : public RegisterBlock, public SerialPort {
 public:
  Usart(UsartSpec spec, ChipContext& context);
  void reset() override;
  void run_events() override;
  void clock_changed() override;
  Cycles stable_until(std::uint32_t offset) const override {
    return (offset & ~3u) == (spec_.v2 ? 0x24u : 0x04u) ? 0 : kNever;
  }

  void feed(std::span<const std::uint8_t> bytes, std::int64_t at_ns, double bit_ns = 0.0) override;
  double baud() const override;
  std::uint64_t overruns() const { return overruns_; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  struct Waiting {
    std::int64_t at_ns;
    std::uint8_t byte;
  };
  std::uint32_t cr1() const { return value(spec_.v2 ? 0x00 : 0x0C); }
  std::uint32_t cr2() const { return value(spec_.v2 ? 0x04 : 0x10); }
  std::uint32_t cr3() const { return value(spec_.v2 ? 0x08 : 0x14); }
  bool on(std::uint32_t which) const;  // TE or RE, with UE
  Cycles bit_cycles() const;
  unsigned frame_bits() const;
  Cycles frame_cycles() const { return bit_cycles() * frame_bits(); }
  void schedule(Cycles& which, Cycles at) {
    which = at;
    next_ = std::min({transmit_end_, receive_at_, idle_at_});
  }
  void show_frame(bool sent, std::uint32_t data, Cycles end) const;
  void transmit(std::uint32_t data);
  void receive(std::uint8_t byte);
  void control_changed();
  void update();
  std::uint32_t take();
  std::size_t capacity() const { return spec_.fifo > 0 && bit(cr1(), 29) ? spec_.fifo : 1; }
  std::size_t received_count() const { return (bit(status_, 5) ? 1u : 0u) + received_more_.size(); }
  std::uint32_t fifo_status() const;

  UsartSpec spec_;
  ChipContext& context_;
  IrqLine irq_;
  int dma_rx_, dma_tx_;
  std::uint32_t status_ = 0;
  bool status_read_ = false;
  std::uint32_t received_ = 0, shifting_ = 0;
  std::deque<std::uint32_t> holding_, received_more_;  // to be sent; behind received_, in a FIFO
  Cycles transmit_end_ = kNever, receive_at_ = kNever, idle_at_ = kNever;
  Cycles next_ = kNever;  // the first of them
  std::deque<Waiting> waiting_;
  std::uint64_t overruns_ = 0;
};

}  // namespace omnihil::mcu
