#include "firmware_iface/mcu/board/boards_memory.h"

#include <memory>

namespace omnihil::mcu {

Machine* BoardsMemory::machine_of(const MemoryPiece& piece) const {
  const bool there =
      piece.space == MemorySpace::kImage && piece.board < boards() && piece.address <= 0xFFFFFFFFu;
  return there ? &firmware_.board(static_cast<int>(piece.board)).machine() : nullptr;
}

bool BoardsMemory::read(std::span<const MemoryPiece> pieces, std::span<std::uint8_t> out) {
  for (const MemoryPiece& piece : pieces) {
    Machine* machine = machine_of(piece);
    if (machine == nullptr || piece.bytes > out.size()) return false;
    if (!machine->memory().read(static_cast<std::uint32_t>(piece.address), out.first(piece.bytes)))
      return false;
    out = out.subspan(piece.bytes);
  }
  return true;
}

bool BoardsMemory::write(const MemoryPiece& piece, std::span<const std::uint8_t> bytes) {
  Machine* machine = machine_of(piece);
  if (machine == nullptr) return false;
  const auto address = static_cast<std::uint32_t>(piece.address);
  const MemoryRegion* region = machine->memory().find(address);
  if (region == nullptr || !region->writable() || bytes.size() > region->size - (address - region->base))
    return false;
  machine->cpu().spoil_fast_forward();
  return machine->memory().write(address, bytes);
}

void BoardsMemory::when_started(std::function<void()> work) {
  const auto main = image_.address_of("main");
  // Boards of one robot start at the same instant and run one after another: the last one's main() counts.
  Machine& last = firmware_.board(static_cast<int>(boards()) - 1).machine();
  if (!main || !last.when_at(*main, work)) work();
}

}  // namespace omnihil::mcu
