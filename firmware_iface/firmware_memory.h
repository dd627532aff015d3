// A firmware's memory, read and written between two of its calls: what variables by name stand on.
//
//   FirmwareMemory* memory = firmware.memory();              // null: it shows none
//   const MemoryPiece piece{.address = 0x20000010, .bytes = 4};
//   std::uint8_t raw[4];
//   if (memory->read({&piece, 1}, raw)) …
#pragma once
#include <cstdint>
#include <functional>
#include <span>

namespace omnihil {

// Where an address counts from.
enum class MemorySpace : std::uint32_t {
  kImage,  // an image's own addresses; of a library those of its file
  kState,  // the begin of a host firmware's state block
};

struct MemoryPiece {
  MemorySpace space = MemorySpace::kImage;
  std::uint32_t board = 0;  // of a robot with several
  std::uint64_t address = 0;
  std::uint64_t bytes = 0;
};

class FirmwareMemory {
 public:
  virtual ~FirmwareMemory() = default;
  // The pieces one behind the other; false: one of them is not there, or the firmware is no more.
  virtual bool read(std::span<const MemoryPiece> pieces, std::span<std::uint8_t> out) = 0;
  // RAM, never flash or constants. False: likewise.
  virtual bool write(const MemoryPiece& piece, std::span<const std::uint8_t> bytes) = 0;
  // Does `work` once start-up code no longer overwrites variables: at main() of an image, else at once.
  virtual void when_started(std::function<void()> work) = 0;
  virtual std::uint32_t boards() const { return 1; }
  virtual std::uint64_t state_bytes() const { return 0; }  // 0: there is no state block
};

}  // namespace omnihil
