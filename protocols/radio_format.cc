#include "protocols/radio_format.h"

#include "protocols/plain_packet.h"

namespace omnihil {

DecodeResult RadioFormat::decode(std::span<const std::uint8_t> frame) const {
  return own_decode != nullptr ? own_decode(frame) : decode_frame(*this, frame);
}

RadioFormat::EncodeResult RadioFormat::encode(const Values& values, std::vector<std::uint8_t>& out) const {
  return own_encode != nullptr ? own_encode(values, out) : encode_frame(*this, values, out);
}

const Message* RadioFormat::find(std::string_view message_name) const {
  for (const Message& message : messages) {
    if (message.name == message_name) return &message;
  }
  return nullptr;
}

bool RadioFormat::names_robots() const {
  for (const Message& message : messages) {
    for (const FieldRole role : {FieldRole::kRobot, FieldRole::kRobotBits}) {
      if (message.field_index(role) >= 0) return true;
    }
  }
  return false;
}

namespace {
std::vector<const RadioFormat*>& formats_in_use() {
  static std::vector<const RadioFormat*> formats;
  return formats;
}
}  // namespace

void use_radio_format(const RadioFormat& format) {
  formats_in_use().insert(formats_in_use().begin(), &format);
}

const RadioFormat* find_radio_format(std::string_view id) {
  for (const RadioFormat* format : formats_in_use()) {
    if (format->id == id) return format;
  }
  for (const RadioFormat* format : radio_formats()) {
    if (format->id == id) return format;
  }
  return nullptr;
}

}  // namespace omnihil
