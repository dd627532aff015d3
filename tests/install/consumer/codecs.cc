// omnihil::protocols: a packet there and back.
#include <cmath>
#include <vector>

#include "protocols/radio_format.h"

bool a_packet_says_what_was_encoded() {
  const omnihil::RadioFormat* format = omnihil::find_radio_format("ulaval-hermes");
  if (format == nullptr) return false;
  omnihil::Values values;
  values.message = format->find("SPEED_MOVE");
  values.set("robot", 3);
  values.set("vx", 0.5);
  std::vector<std::uint8_t> frame;
  if (format->encode(values, frame).error != omnihil::PacketError::kNone) return false;
  const omnihil::DecodeResult decoded = format->decode(frame);
  frame[3] ^= 1;  // a bit of the packet's type
  return decoded.error == omnihil::PacketError::kNone && decoded.values.number("robot") == 3 &&
         decoded.values.number("vx") == 0.5 && format->decode(frame).error != omnihil::PacketError::kNone;
}
