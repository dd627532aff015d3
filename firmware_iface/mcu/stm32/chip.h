// A microcontroller: its memories, its core, and the blocks at their addresses.
//
//   const ChipSpec* spec = find_chip("stm32f407");
//   Machine machine(machine_config(*spec));
//   Chip chip(*spec, machine);
//   attach(chip, machine);
//
// Adding a chip is adding a file to firmware_iface/mcu/stm32/chips/ that defines `const ChipSpec& chip_STEM()`.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "firmware_iface/mcu/core/variant.h"
#include "firmware_iface/mcu/machine/machine.h"
#include "firmware_iface/mcu/stm32/adc/adc.h"
#include "firmware_iface/mcu/stm32/block_map.h"
#include "firmware_iface/mcu/stm32/chip_context.h"
#include "firmware_iface/mcu/stm32/clock/flash.h"
#include "firmware_iface/mcu/stm32/pin_bank.h"

namespace omnihil::mcu {

class Chip;

struct MemorySpec {
  std::string_view name;
  std::uint32_t base = 0, bytes = 0;
  bool flash = false;
  bool core_only = false;  // no DMA controller reaches it
  bool rom = false;        // nobody writes there
};

struct ChipSpec {
  std::string_view name;
  std::vector<std::string_view> variants;  // other names of what is the same here
  Variant core = kCortexM4F;
  BlockFamily blocks = BlockFamily::kUnknown;  // what is where, for messages
  double reset_hz = 16e6;
  double crystal_hz = 8e6;      // where a board does not say it
  bool boots_from_rom = false;  // the vectors are at 0 at reset
  // Else where they are. 0: at the flash's base; else as the chip's option bytes are delivered, and a
  // board may say another.
  std::uint32_t boot_address = 0;
  std::vector<MemorySpec> memories;
  std::vector<std::pair<std::string_view, std::uint32_t>> aliases = {};  // of a memory, at another base
  std::vector<ElfRange> used_low = {};  // below 4096: what a program reads and means it
  void (*build)(Chip& chip) = nullptr;
};

std::span<const ChipSpec* const> all_chips();
const ChipSpec* find_chip(std::string_view name);  // by name or variant, whatever the case
std::string chip_name(std::string_view name);      // as the lists have it: in lower case
MachineConfig machine_config(const ChipSpec& spec);
void attach(Chip& chip, Machine& machine);  // every block at its address

class Chip {
 public:
  struct Mapped {
    std::uint32_t base, bytes;
    Peripheral* peripheral;
  };
  Chip(const ChipSpec& spec, System& system);

  const ChipSpec& spec() const { return spec_; }
  ChipContext& context() { return context_; }
  const std::vector<Mapped>& blocks() const { return blocks_; }
  void reset();
  // nullptr where the chip has none of that name or it is of another kind: chip.find<Timer>("TIM1").
  template <class Kind>
  Kind* find(std::string_view name) const {
    return dynamic_cast<Kind*>(peripheral(name));
  }
  PinBank* port(char letter) const;
  const std::vector<PinBank*>& ports() const { return ports_; }
  Flash* flash() const;
  // Names of the blocks of one kind, for messages.
  template <class Kind>
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const Mapped& block : blocks_) {
      if (dynamic_cast<Kind*>(block.peripheral) != nullptr) found.push_back(block.peripheral->name());
    }
    return found;
  }

  // For the chips' files.
  void when_attached(std::function<void(Machine&)> work) { when_attached_.push_back(std::move(work)); }
  template <class Kind>
  Kind& add(std::uint32_t base, std::uint32_t bytes, std::unique_ptr<Kind> peripheral) {
    Kind& kept = *peripheral;
    owned_.push_back(std::move(peripheral));
    blocks_.push_back({base, bytes, &kept});
    if constexpr (std::is_base_of_v<PinBank, Kind>) ports_.push_back(&kept);
    return kept;
  }

 private:
  Peripheral* peripheral(std::string_view name) const;
  const ChipSpec& spec_;
  ChipContext context_;
  std::vector<std::unique_ptr<Peripheral>> owned_;
  std::vector<Mapped> blocks_;
  std::vector<PinBank*> ports_;
  std::vector<std::function<void(Machine&)>> when_attached_;
  friend void attach(Chip& chip, Machine& machine);
};

}  // namespace omnihil::mcu
