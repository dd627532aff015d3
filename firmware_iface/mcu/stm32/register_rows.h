// A block's table of registers in parts, where generations of a block differ in some of its rows; in the manual's order.
//
//   static constexpr RegisterInfo kControl[2] = {}, kData[3] = {};
//   constexpr auto kBlock = joined(kControl, kData);                  // 5 rows
#pragma once
#include <array>
#include <cstddef>

#include "firmware_iface/mcu/stm32/register_block.h"

namespace omnihil::mcu {

template <std::size_t... kCounts>
constexpr auto joined(const RegisterInfo (&... parts)[kCounts]) {
  std::array<RegisterInfo, (kCounts + ...)> all{};
  std::size_t at = 0;
  const auto append = [&](const auto& part) {
    for (const RegisterInfo& row : part) all[at++] = row;
  };
  (append(parts), ...);
  return all;
}

}  // namespace omnihil::mcu
