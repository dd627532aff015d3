// Rows of classic CAN frames as Linux has them in `struct can_frame`, little-endian: 11-bit id and flags (4 bytes), number of
// data bytes, three bytes of padding, 8 bytes of data. What a raw CAN socket reads and writes, and `emit_dbc` understands.
#pragma once
#include <array>

#include "protocols/field_rows.h"

namespace omnihil::can {

inline constexpr int kFrameBytes = 16;

// Between the 11 bits of the id and the data.
constexpr auto head(std::uint64_t data_bytes) {
  return std::array{
      enveloped(constant("id_29", 18, 0, "0: the id has 11 bits")),
      enveloped(constant("err_rtr_eff", 3, 0, "0: a data frame")),
      enveloped(constant("dlc", 8, data_bytes, "bytes of data")),
      enveloped(reserved("padding", 24, "not used")),
  };
}
// The data bytes that the frame does not have.
template <int kBits>
constexpr auto rest() {
  return std::array{enveloped(reserved("rest", kBits, "behind the data"))};
}

constexpr Message row(std::string_view name, std::uint32_t type, std::span<const Field> fields,
                      std::string_view what, MessageRole role) {
  return {name, type, kFrameBytes, false, Direction::kInside, BitOrder::kLsbFirst, fields, what, role};
}

}  // namespace omnihil::can
