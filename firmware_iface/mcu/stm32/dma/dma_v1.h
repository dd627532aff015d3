// DMA controller with channels (F0, F1, F3, G4, L4; BDMA of H7), and the request multiplexer of G4 and H7.
//
//   DmaV1 dma("DMA1", {11, 12, 13, 14, 15, 16, 17}, context);
//   dma.connect("USART1_TX", 4);             // fixed wiring; on G4: dma.use_mux(mux, 0)
//
// Law: RM0316 §13, RM0440 §12-13. A transfer takes no bus time: an item moves at the instant of its request.
// Cannot represent: arbitration and priorities, transfer errors, request generators and synchronisation of
// the DMAMUX.
#pragma once
#include <vector>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/dma/dma_item.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

class DmaMux final : public RegisterBlock {
 public:
  // `requests`: names by request number.
  DmaMux(const char* name, const std::vector<std::pair<unsigned, std::string>>& requests,
         ChipContext& context);
  int line(unsigned channel) const;  // the request line that the channel is set to; -1: none

 private:
  std::vector<int> lines_;  // by request number
};

class DmaV1 final : public RegisterBlock, public DmaSink, public DmaErrors {
 public:
  DmaV1(const std::string& name, std::vector<int> irqs, ChipContext& context);  // one interrupt per channel
  // Channels from 1. `code`: what CSELR has to say for it (L4); below 0: wired for good.
  void connect(std::string_view request, unsigned channel, int code = -1);
  void use_mux(const DmaMux& mux, unsigned first);
  void reset() override;
  void requested(int line) override;
  bool fail_transfer() override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  struct Wire {
    int line, code;
  };
  struct Channel {
    DmaTransfer transfer;
    std::uint32_t left = 0, all = 0;
    std::vector<Wire> wires;
  };
  std::uint32_t& reg(unsigned channel, unsigned which) { return value(0x08 + 20 * channel + 4 * which); }
  bool serves(unsigned channel, int line) const;
  bool chosen(unsigned channel, int code) const {
    return code < 0 || field(value(0xA8), 4 * channel, 4) == static_cast<unsigned>(code);
  }
  std::uint32_t wired_to(int line) const;
  void start(unsigned channel);
  void item(unsigned channel);
  void fail(unsigned channel);
  void update_irqs();
  void update_irq(unsigned channel);

  ChipContext& context_;
  std::vector<Channel> channels_;
  std::vector<std::uint8_t> wired_to_;  // by request line, a bit for each channel
  std::vector<IrqLine> irqs_;
  const DmaMux* mux_ = nullptr;
  unsigned mux_first_ = 0;
};

}  // namespace omnihil::mcu
