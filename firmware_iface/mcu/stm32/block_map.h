// Where the blocks of each family of chips are, whether modelled or not: so that what an image touches and the
// emulation lacks has its name.
//
//   block_at(BlockFamily::kF7, 0x40012C34)->name;      // "SDMMC1"
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace omnihil::mcu {

enum class BlockFamily : std::uint8_t {
  kUnknown,
  kF0,
  kF1,
  kF3,
  kF4,
  kF446,
  kF7,
  kG0,
  kG4,
  kH7,
  kL4,
  kRp2040
};

struct BlockPlace {
  std::string_view name;
  std::uint32_t base, bytes;
};

const BlockPlace* block_at(BlockFamily family, std::uint32_t address);  // null: reserved, or not known

}  // namespace omnihil::mcu
