// SPI master: v1 (F4), v2 (F0, F3, F7, G4) and v3 (H7) registers. Devices hang on it behind chip-select pins.
//
//   std::unique_ptr<Spi> spi = make_spi({.name = "SPI1", .v2 = false, .bus = Bus::kApb2, .irq = 35}, context);
//   spi->connect(device);                 // takes part while select() said so
//   spi->select(device, true);
//
// Law: RM0090 §28, RM0316 §30, RM0433 §50. A frame of 4..16 bits takes 2^(BR+1) bus clocks per bit; what the device
// answers is there with the last of them. Frames above 8 bits are two bytes (v3: up to four) to the device, high byte first.
// No device selected: reads ones, and is counted. v2: transmit and receive FIFOs of 4 bytes, packing of byte pairs by 16-bit
// accesses. v3: FIFOs of 8 or 16 bytes, transfers of TSIZE frames, packing by wider accesses. Cannot represent: slave mode,
// I2S, CRC, LSB first, half duplex (reads as full duplex), clock phase and polarity (devices answer in any), the I2S
// halves.
#pragma once
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/bus_ledger.h"
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/device.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

struct SpiSpec {
  std::string name = "SPI1";
  bool v2 = false;
  Bus bus = Bus::kApb2;
  int irq = -1;
  unsigned fifo_bytes = 0;  // above 0: v3
};

// What passed on its lines, the highest bit first.
struct SpiFrame {
  std::uint32_t out = 0, in = 0;  // of master and device
  unsigned bits = 0;
  Cycles begin = 0, end = 0;
  bool idle_high = false, second_edge = false;  // CPOL, CPHA
};

class Spi : public RegisterBlock, public BusEnd {
 public:
  Spi(SpiSpec spec, std::span<const RegisterInfo> registers, ChipContext& context);
  void connect(SpiDevice& device) { devices_.push_back({&device, false}); }
  void select(SpiDevice& device, bool selected);
  // For whoever draws the lines: each frame at its end.
  void watch_frames(std::function<void(const SpiFrame&)> watcher) { watcher_ = std::move(watcher); }

 protected:
  // One frame with whoever is selected.
  std::uint32_t exchange(std::uint32_t out, unsigned bits);
  void passed(const SpiFrame& frame) const {
    if (watcher_) watcher_(frame);
  }
  SpiSpec spec_;
  ChipContext& context_;
  IrqLine irq_;
  int dma_rx_, dma_tx_;

 private:
  struct Slave {
    SpiDevice* device;
    bool selected;
  };
  std::vector<Slave> devices_;
  std::function<void(const SpiFrame&)> watcher_;
};

std::unique_ptr<Spi> make_spi(const SpiSpec& spec, ChipContext& context);
std::unique_ptr<Spi> make_spi_v3(const SpiSpec& spec, ChipContext& context);

}  // namespace omnihil::mcu
