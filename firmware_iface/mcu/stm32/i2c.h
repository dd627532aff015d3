// I2C master: v1 (F4) and v2 (F0, F3, F7, G4) registers; devices on the bus answer to their address, nobody
// else does.
//
//   I2cSpec spec{.name = "I2C1", .v2 = false, .bus = Bus::kApb1, .irq_event = 31, …};
//   std::unique_ptr<I2c> i2c = make_i2c(spec, context);
//   i2c->connect(device);
//
// Law: RM0090 §27, RM0316 §28. Every byte takes nine clocks of the bus; an address that no device has is not
// acknowledged (AF, NACKF): a driver's time-outs see what they would with the part missing.
// Cannot represent: slave mode, 10-bit addresses, SMBus, arbitration, clock stretching by devices.
#pragma once
#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/stm32/bus_ledger.h"
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/device.h"
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

struct I2cSpec {
  std::string name = "I2C1";
  bool v2 = false;
  bool from_hsi = false;  // v2: its clock is the HSI (F0, F3), else the bus's
  Bus bus = Bus::kApb1;
  int irq_event = -1, irq_error = -1;  // error below 0: with the events
};

class I2c : public RegisterBlock, public BusEnd {
 public:
  I2c(I2cSpec spec, std::span<const RegisterInfo> registers, ChipContext& context)
      : RegisterBlock(spec.name, context.system, registers),
        spec_(std::move(spec)),
        context_(context),
        irq_event_(context.irqs, spec_.irq_event),
        irq_error_(context.irqs, spec_.irq_error < 0 ? spec_.irq_event : spec_.irq_error),
        dma_rx_(context.dma.line(spec_.name + "_RX")),
        dma_tx_(context.dma.line(spec_.name + "_TX")) {}
  void connect(I2cDevice& device) { devices_.push_back(&device); }

 protected:
  I2cDevice* find(std::uint32_t address) {
    for (I2cDevice* device : devices_) {
      if (device->address() == address) return device;
    }
    ledger_.lost("call", fmt::format("to address 0x{:02x}, which no device has", address), now());
    return nullptr;
  }
  I2cSpec spec_;
  ChipContext& context_;
  IrqLine irq_event_, irq_error_;
  int dma_rx_, dma_tx_;

 private:
  std::vector<I2cDevice*> devices_;
};

std::unique_ptr<I2c> make_i2c(const I2cSpec& spec, ChipContext& context);
std::unique_ptr<I2c> make_i2c_v1(const I2cSpec& spec, ChipContext& context);
std::unique_ptr<I2c> make_i2c_v2(const I2cSpec& spec, ChipContext& context);

}  // namespace omnihil::mcu
