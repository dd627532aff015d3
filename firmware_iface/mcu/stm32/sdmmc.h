// The host of a memory card: SDIO of F1 and F4 and SDMMC of F7 (v1), SDMMC of H7 (v2).
//
//   Sdmmc host({.name = "SDMMC1", .v2 = true, .irq = 49}, context);
//   host.connect(card);
//
// Law: RM0410 §39, RM0433 §55. A command takes 48 clocks of SDMMC_CK, 5 more and 48 or 136 of its answer; eight words of
// data as many as the width of the bus says, a block 18 more. Data pass a FIFO of 32 (v2: 16) words, by accesses, by a DMA
// controller (v1) or by a DMA of its own (v2) that writes to memory at once. Flow control stops the clock; without it the
// FIFO runs over or dry. Cannot represent: CRC errors, SDIO cards and their interrupts, boot mode, voltage switch,
// double data rate, delay blocks.
#pragma once
#include <algorithm>
#include <deque>
#include <string>
#include <vector>

#include "firmware_iface/mcu/stm32/bus_ledger.h"
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/register_block.h"
#include "firmware_iface/mcu/stm32/sd_bus.h"

namespace omnihil::mcu {

struct SdmmcSpec {
  std::string name = "SDMMC1";
  bool v2 = false;
  int irq = -1;
};

class Sdmmc final : public RegisterBlock, public BusEnd {
 public:
  Sdmmc(SdmmcSpec spec, ChipContext& context);
  void reset() override;
  void run_events() override;
  Cycles stable_until(std::uint32_t offset) const override { return offset >= 0x80 ? 0 : kNever; }
  void connect(SdDevice& card) { card_ = &card; }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  enum class Data : std::uint8_t { kIdle, kReceive, kTransmit };
  std::size_t fifo_words() const { return spec_.v2 ? 16 : 32; }
  bool own_dma() const { return spec_.v2 && bit(value(0x50), 0); }
  bool flow_control() const { return own_dma() || bit(value(0x04), spec_.v2 ? 17 : 14); }
  bool moving() const { return data_ != Data::kIdle && moved_; }
  Cycles clocks(std::uint64_t count) const;
  unsigned bus_width() const;
  // DTMODE: bytes without blocks, which is one block of all of them.
  bool stream() const { return spec_.v2 ? field(value(0x2C), 2, 2) % 3 != 0 : bit(value(0x2C), 2); }
  std::uint32_t block_bytes() const {
    const std::uint32_t most = std::max(left_, 1u);
    return stream() ? most : std::min(1u << field(value(0x2C), 4, 4), most);
  }
  std::uint32_t piece_bytes() const;  // of the next piece of a block
  Cycles piece_cycles() const;
  std::int64_t now_ns() const { return system().to_ns(now()); }
  Cycles at_ns(std::int64_t ns) const { return std::max(now(), system().from_ns(ns)); }
  void control_command(std::uint32_t written);
  void finish_command();
  void arm();
  void look_for_data();
  void piece_done();
  void receive_piece();
  void transmit_piece();
  void end_block();
  void memory_moved();
  std::uint32_t status() const;
  void schedule();
  void update();

  SdmmcSpec spec_;
  ChipContext& context_;
  IrqLine irq_;
  int dma_;
  SdDevice* card_ = nullptr;
  std::uint32_t flags_ = 0;
  std::deque<std::uint32_t> fifo_;
  Data data_ = Data::kIdle;
  bool moved_ = false;  // some of this transfer
  std::uint32_t left_ = 0, block_left_ = 0,
                to_feed_ = 0;                      // bytes of the transfer, of the block; words of the image
  std::vector<std::uint8_t> block_;                // what has been sent of it
  std::uint32_t memory_at_ = 0, memory_left_ = 0;  // of its own DMA
  Cycles command_end_ = kNever, data_at_ = kNever, timeout_at_ = kNever, busy_end_ = kNever;
  Cycles next_ = kNever;  // the first of them
};

}  // namespace omnihil::mcu
