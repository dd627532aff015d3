// The data memory of a robot's AVR boards, as variables by name need it.
//
//   AvrMemory memory(boards, image.main);
//   memory.read({&piece, 1}, raw);        // an address of the ELF file: 0x800000 + that of the chip
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "firmware_iface/firmware_memory.h"
#include "hil/firmware/avr_board.h"

namespace omnihil {

class AvrMemory final : public FirmwareMemory {
 public:
  AvrMemory(const std::vector<std::unique_ptr<AvrBoard>>& boards, std::optional<std::uint32_t> main)
      : boards_(boards), main_(main) {}

  bool read(std::span<const MemoryPiece> pieces, std::span<std::uint8_t> out) override;
  bool write(const MemoryPiece& piece, std::span<const std::uint8_t> bytes) override;
  // When the last of the boards comes to the image's main(); of an image without such a symbol at once.
  void when_started(std::function<void()> work) override;
  std::uint32_t boards() const override { return static_cast<std::uint32_t>(boards_.size()); }

  // Waits for all boards, which run, and does what waits for them to be started.
  void finish_all();

 private:
  static std::optional<AvrBytes> place_of(const MemoryPiece& piece);

  const std::vector<std::unique_ptr<AvrBoard>>& boards_;
  std::optional<std::uint32_t> main_;
  std::vector<std::function<void()>> waiting_;
  std::size_t started_ = 0;  // boards that have come to main()
  std::vector<std::vector<AvrBytes>> asked_;
  std::vector<std::vector<std::uint8_t>> answers_;
};

}  // namespace omnihil
