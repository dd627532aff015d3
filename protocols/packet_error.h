// Why a packet was refused. Bad bytes are a status, counted by cause, never thrown, never acted on.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace omnihil {

enum class PacketError : std::uint8_t {
  kNone,
  kTooShort,     // fewer bytes than the smallest packet or than its type needs
  kTooLong,      // more bytes than the type has
  kFraming,      // COBS code past the end, delimiter inside, no delimiter within the longest frame
  kChecksum,     // sum or CRC does not match
  kVersion,      // protocol version of another dialect
  kUnknownType,  // no message with this code
  kLength,       // length field contradicts the type or the bytes
  kConstant,     // a sync or constant field has another value
  kRange,        // a field's value is outside what the table allows
  kNotFinite,    // NaN or infinity in a float field
  kAddress,      // names a robot that is not there, or the other team's
  kDirection,    // a packet that only a robot may send, from the host (or the reverse)
  kOverrun,      // dropped because a queue or buffer was full
  kCount
};

// "checksum", "unknown type", … as printed in reports and JSON.
std::string_view to_string(PacketError error);

// Packets seen in one direction, good ones and refused ones by cause.
struct PacketCounts {
  std::uint64_t good = 0;
  std::array<std::uint64_t, static_cast<std::size_t>(PacketError::kCount)> bad{};

  void count(PacketError error) {
    error == PacketError::kNone ? ++good : ++bad[static_cast<std::size_t>(error)];
  }
  std::uint64_t refused() const {
    std::uint64_t sum = 0;
    for (std::uint64_t n : bad) sum += n;
    return sum;
  }
};

}  // namespace omnihil
