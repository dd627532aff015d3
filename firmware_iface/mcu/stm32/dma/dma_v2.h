// DMA controller with streams (F4, F7, H7).
//
//   DmaV2 dma(2, {56, 57, 58, 59, 60, 68, 69, 70}, context);
//   dma.connect("USART1_TX", 7, 4);          // stream 7, channel 4; on H7: dma.use_mux(mux, 8)
//
// Law: RM0090 §10. A transfer takes no bus time: an item moves at the instant of its request; FIFO and bursts
// change nothing that memory shows at the end. Double-buffer mode is modelled, peripheral flow control and
// errors are not.
#pragma once
#include <vector>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/dma/dma_item.h"
#include "firmware_iface/mcu/stm32/dma/dma_v1.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

class DmaV2 final : public RegisterBlock, public DmaSink, public DmaErrors {
 public:
  DmaV2(int number, std::vector<int> irqs, ChipContext& context);
  void connect(std::string_view request, unsigned stream, unsigned channel);
  void use_mux(const DmaMux& mux, unsigned first);
  // Each stream's complete flag is a request of its own, by the name DMAx_TCn: what the H7's MDMA hears.
  void announce_ends();
  void reset() override;
  void requested(int line) override;
  bool fail_transfer() override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  struct Row {
    int line;
    unsigned stream, channel;
  };
  struct Stream {
    DmaTransfer transfer;
    std::uint32_t left = 0, all = 0;
  };
  std::uint32_t& reg(unsigned stream, unsigned which) { return value(0x10 + 24 * stream + 4 * which); }
  void serve(unsigned stream, int line);
  void start(unsigned stream);
  void item(unsigned stream);
  void fail(unsigned stream);
  void flag(unsigned stream, std::uint32_t flags);
  std::uint32_t flags(unsigned stream) const;
  void update_irqs();
  void update_ends();

  ChipContext& context_;
  std::vector<Row> rows_;
  std::vector<Stream> streams_;
  std::vector<IrqLine> irqs_;
  const DmaMux* mux_ = nullptr;
  unsigned mux_first_ = 0;
  std::vector<int> ends_;  // lines; empty: nobody hears
};

}  // namespace omnihil::mcu
