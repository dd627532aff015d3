// Master DMA of the H7: sixteen channels that move buffers, blocks, repeated blocks and linked lists.
//
//   Mdma mdma(122, {"DMA1_TC0", "DMA1_TC1"}, context);      // lines by their number in TSEL; "": not modelled
//
// Law: RM0433 §14. A request, by software (SWRM and SWRQ) or by the line that TSEL names while it is high, is served at its
// instant: a buffer of TLEN + 1 bytes, a block of BNDT bytes, BRC + 1 blocks whose addresses BRUR moves, or the whole list
// (TRGM); after each buffer MDR is written to MAR, if that is not 0. At the end of the blocks the channel is loaded from LAR,
// or off with CTCIF if that is 0. Items of two sizes are packed (PKE), or right-aligned, zeros above. TCM is reached by SBUS
// and DBUS, and nothing else by them.
// Approximate: a transfer takes no bus time, so that priorities never matter and CRQA reads 0. Cannot: exchanges of bytes (BEX,
// HEX, WEX), PAM's sign extension and left alignment, requests of LTDC, JPEG, QUADSPI, DMA2D, DSI and SDMMC1.
#pragma once
#include <string>
#include <vector>

#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/dma/dma_item.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

class Mdma final : public RegisterBlock, public DmaSink, public DmaErrors {
 public:
  Mdma(int irq, const std::vector<std::string>& requests, ChipContext& context);
  void reset() override;
  void requested(int line) override;
  bool fail_transfer() override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  enum class Over : std::uint8_t { kBuffer, kBlock, kBlocks, kChannel };
  std::uint32_t& reg(unsigned channel, std::uint32_t offset) { return value(0x40 + 0x40 * channel + offset); }
  bool active(unsigned channel);
  void control(unsigned channel, std::uint32_t written, std::uint32_t lanes);
  void start(unsigned channel);
  int line_of(unsigned channel);  // -1: by software, or not modelled
  void serve(unsigned channel);
  Over move_buffer(unsigned channel);
  Over end_block(unsigned channel);
  bool move_bytes(unsigned channel, std::uint32_t bytes);
  bool reaches(unsigned channel, std::uint32_t address, bool is_write);
  std::uint64_t read_item(std::uint32_t address, unsigned size);
  void write_item(std::uint32_t address, unsigned size, std::uint64_t item);
  void fail(unsigned channel, std::uint32_t error);
  void update_irq();

  ChipContext& context_;
  IrqLine irq_;
  std::vector<int> lines_;
  std::vector<std::uint32_t> block_bytes_;  // of each channel's whole block
};

}  // namespace omnihil::mcu
