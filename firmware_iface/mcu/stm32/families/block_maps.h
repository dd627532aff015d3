// The maps of families that have a file of their own, for block_map.cc.
//
//   const BlockPlace first = block_map_f1().front();
#pragma once
#include <span>

#include "firmware_iface/mcu/stm32/block_map.h"

namespace omnihil::mcu {

std::span<const BlockPlace> block_map_f1();
std::span<const BlockPlace> block_map_g0();
std::span<const BlockPlace> block_map_h7();
std::span<const BlockPlace> block_map_l4();
std::span<const BlockPlace> block_map_rp2040();

}  // namespace omnihil::mcu
