// Where a debugger halts the core: instructions, and accesses to memory.
#include <algorithm>

#include "firmware_iface/mcu/core/cpu.h"

namespace omnihil::mcu {

void Cpu::set_halts(std::vector<std::uint32_t> addresses) {
  std::ranges::sort(addresses);
  if (addresses == halts_) return;
  const std::uint32_t here = reg.r[15];
  const std::uint8_t it = it_at(here);  // is forgotten with what is decoded
  std::vector<std::uint32_t> changed;
  std::ranges::set_symmetric_difference(halts_, addresses, std::back_inserter(changed));
  halts_ = std::move(addresses);
  for (const std::uint32_t pc : changed) forget_decoded(pc);
  if (it != 0) resume_it(here, it);
}

void Cpu::forget_decoded(std::uint32_t pc) {
  const MemoryRegion* region = memory_.find(pc);
  if (region != nullptr) memory_.invalidate(*region->block, pc - region->base, 2);
}

void Cpu::set_watches(std::vector<AccessWatch> watches) {
  const bool windows_change = watches.empty() != watches_.empty();
  watches_ = std::move(watches);
  if (windows_change) memory_changed();
}

void Cpu::note_watched(std::uint32_t address, unsigned bytes, AccessKinds kind) {
  for (const AccessWatch& watch : watches_) {
    const bool touches = address < std::uint64_t{watch.address} + watch.bytes &&
                         watch.address < std::uint64_t{address} + bytes;
    if (!touches || (watch.kinds & kind) == 0 || hit_) continue;
    hit_ = {watch, kind == kWrites};
    stop_requested_ = true;
  }
}

}  // namespace omnihil::mcu
