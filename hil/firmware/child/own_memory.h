// The memory of the library and of its state block, read and written by address for the bench (wire.h).
//
//   std::vector<std::uint8_t> answer = peek(pieces, library, block);      // first byte 1: the pieces' bytes follow
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "hil/firmware/child/state_block.h"

namespace omnihil {

std::vector<std::uint8_t> peek(std::span<const std::uint8_t> pieces, void* library, StateBlock* block);
std::uint8_t poke(std::span<const std::uint8_t> piece_and_bytes, void* library, StateBlock* block);

}  // namespace omnihil
