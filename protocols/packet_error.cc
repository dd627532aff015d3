#include "protocols/packet_error.h"

namespace omnihil {

std::string_view to_string(PacketError error) {
  switch (error) {
    case PacketError::kNone:
      return "none";
    case PacketError::kTooShort:
      return "too short";
    case PacketError::kTooLong:
      return "too long";
    case PacketError::kFraming:
      return "framing";
    case PacketError::kChecksum:
      return "checksum";
    case PacketError::kVersion:
      return "version";
    case PacketError::kUnknownType:
      return "unknown type";
    case PacketError::kLength:
      return "length";
    case PacketError::kConstant:
      return "constant";
    case PacketError::kRange:
      return "range";
    case PacketError::kNotFinite:
      return "not finite";
    case PacketError::kAddress:
      return "address";
    case PacketError::kDirection:
      return "direction";
    case PacketError::kOverrun:
      return "overrun";
    case PacketError::kCount:
      break;
  }
  return "?";
}

}  // namespace omnihil
