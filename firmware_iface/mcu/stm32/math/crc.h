// The CRC unit: v1 (F4) with its one polynomial and words alone, v2 (F0, F3, F7, G4).
//
//   chip.add(0x40023000, 0x400, std::make_unique<Crc>(CrcFamily::kV2, chip.context().system));
//
// Law: RM0090 §4, RM0316 §6, RM0091 §12. A write of the data register takes its bits in, the most significant
// first: a word, and in v2 a byte or a half-word as it is accessed. v2: start value, polynomial of 7, 8, 16 or 32 bits (not
// F03x: 32 alone), input turned round by bytes, half-words or words, output turned round. Cannot represent: the
// cycles of a word (a read right behind a write waits on silicon, and is at once right here).
#pragma once
#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

enum class CrcFamily : std::uint8_t { kV1, kV2, kV2FixedPolynomial };

class Crc final : public RegisterBlock {
 public:
  Crc(CrcFamily family, System& system);
  void reset() override;

 protected:
  std::uint32_t load(std::uint32_t offset) override;
  void store(std::uint32_t offset, std::uint32_t written, std::uint32_t lanes) override;

 private:
  unsigned size_bits() const;
  void start();
  void take(std::uint32_t data, unsigned bits);

  CrcFamily family_;
};

}  // namespace omnihil::mcu
