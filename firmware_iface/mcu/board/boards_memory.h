// The RAM of a robot's boards, as whoever reads and writes variables by name needs it.
//
//   BoardsMemory memory(mcu_firmware, image);
//   memory.read({&piece, 1}, raw);
#pragma once
#include "firmware_iface/firmware_memory.h"
#include "firmware_iface/mcu/board/mcu_firmware.h"

namespace omnihil::mcu {

class BoardsMemory final : public FirmwareMemory {
 public:
  BoardsMemory(McuFirmware& firmware, const ElfImage& image) : firmware_(firmware), image_(image) {}

  bool read(std::span<const MemoryPiece> pieces, std::span<std::uint8_t> out) override;
  bool write(const MemoryPiece& piece, std::span<const std::uint8_t> bytes) override;
  // At the image's main(), of every board; of an image without such a symbol at once.
  void when_started(std::function<void()> work) override;
  std::uint32_t boards() const override { return static_cast<std::uint32_t>(firmware_.boards()); }

 private:
  Machine* machine_of(const MemoryPiece& piece) const;

  McuFirmware& firmware_;
  const ElfImage& image_;
};

}  // namespace omnihil::mcu
