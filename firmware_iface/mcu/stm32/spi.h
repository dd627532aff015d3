// SPI master: v1 (F4) and v2 (F0, F3, F7, G4) over one law. Devices hang on it behind chip-select pins.
//
//   Spi spi({.name = "SPI1", .v2 = false, .bus = Bus::kApb2, .irq = 35}, context);
//   spi.connect(device);                 // takes part while select() said so
//   spi.select(device, true);
//
// Law: RM0090 §28, RM0316 §30. A frame of 4..16 bits takes 2^(BR+1) bus clocks per bit; what the device
// answers is there with the last of them. Frames of 16 bits are two bytes to the device, high byte first. No
// device selected: reads ones, and is counted. v2: transmit and receive FIFOs of 4 bytes, packing of byte pairs by 16-bit
// accesses. Cannot represent: slave mode, I2S, CRC, LSB first, half duplex (reads as full duplex), clock
// phase and polarity (devices answer in any), the I2S halves.
#pragma once
#include <algorithm>
#include <deque>
#include <functional>
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
};

// What passed on its lines, the highest bit first.
struct SpiFrame {
  std::uint32_t out = 0, in = 0;  // of master and device
  unsigned bits = 0;
  Cycles begin = 0, end = 0;
  bool idle_high = false, second_edge = false;  // CPOL, CPHA
};

class Spi final : public RegisterBlock, public BusEnd {
 public:
  Spi(SpiSpec spec, ChipContext& context);
  void reset() override;
  void run_events() override;
  Cycles stable_until(std::uint32_t offset) const override { return (offset & ~3u) == 0x0C ? 0 : kNever; }

  void connect(SpiDevice& device) { devices_.push_back({&device, false}); }
  void select(SpiDevice& device, bool selected);
  // For whoever draws the lines: each frame at its end.
  void watch_frames(std::function<void(const SpiFrame&)> watcher) { watcher_ = std::move(watcher); }

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  std::uint32_t shown(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  struct Slave {
    SpiDevice* device;
    bool selected;
  };
  unsigned frame_bits() const;
  bool wide() const { return frame_bits() > 8; }
  std::size_t capacity() const { return spec_.v2 ? (wide() ? 2 : 4) : 1; }
  std::size_t ready_at() const { return spec_.v2 && !wide() && !bit(value(0x04), 12) ? 2 : 1; }
  Cycles frame_cycles() const;
  std::uint32_t exchange(std::uint32_t out);
  void push(std::uint32_t frame);
  void begin();
  std::uint32_t status() const;
  void update();

  SpiSpec spec_;
  ChipContext& context_;
  IrqLine irq_;
  int dma_rx_, dma_tx_;
  std::vector<Slave> devices_;
  std::deque<std::uint32_t> transmit_, receive_;
  std::uint32_t shifting_ = 0;
  bool overrun_ = false;
  Cycles frame_end_ = kNever;
  std::function<void(const SpiFrame&)> watcher_;
};

}  // namespace omnihil::mcu
