#include "protocols/dongles/table_frames.h"

#include <algorithm>

#include "protocols/codec.h"
#include "protocols/dongles/dongle.h"

namespace omnihil {
namespace {

using Front = std::span<const std::uint8_t>;
using Size = std::optional<std::size_t>;
constexpr Size kNoFrame = std::size_t{0};

template <class Bytes>
bool begins_alike(Front front, const Bytes& with) {
  return std::equal(
      front.begin(), front.begin() + static_cast<std::ptrdiff_t>(std::min(front.size(), with.size())),
      with.begin(), with.begin() + static_cast<std::ptrdiff_t>(std::min(front.size(), with.size())),
      [](auto a, auto b) { return a == static_cast<std::uint8_t>(b); });
}

Size delimited(const RadioFormat& format, Front front) {
  const auto delimiter = std::find(front.begin(), front.end(), std::uint8_t{0});
  if (delimiter != front.end()) return static_cast<std::size_t>(delimiter - front.begin()) + 1;
  return front.size() < static_cast<std::size_t>(format.max_frame_bytes) ? std::nullopt : kNoFrame;
}

Size listed(const RadioFormat& format, Front front) {
  const PacketList& list = *format.list;
  if (!begins_alike(front, list.begin)) return kNoFrame;
  if (front.size() <= list.begin.size()) return std::nullopt;
  const std::size_t number = front[list.begin.size()];
  if (number > static_cast<std::size_t>(list.most)) return kNoFrame;
  std::size_t packet_bytes = 0;
  for (const Message& message : format.messages) {
    if (!never_from_host(message)) packet_bytes = static_cast<std::size_t>(message.size_bytes);
  }
  return list.begin.size() + 2 + number * packet_bytes;
}

// Of this message: its length, more bytes are needed, or it is not.
Size of_message(const Message& message, Front front) {
  const auto size = static_cast<std::size_t>(message.size_bytes);
  bool whole = true;
  for (const Field& field : message.fields) {
    const bool is_type = field.kind == FieldKind::kType;
    if (!is_type && field.kind != FieldKind::kConst) continue;
    if (static_cast<std::size_t>(field.bit + field.bits + 7) / 8 > front.size()) {
      whole = whole && !is_type;
    } else if (read_bits(front, field.bit, field.bits, message.bit_order) !=
               required_raw(field, message, size)) {
      return kNoFrame;
    }
  }
  if (!whole || !message.text_tail) return whole ? Size(size) : std::nullopt;
  if (front.size() < size) return std::nullopt;
  for (const Field& field : message.fields) {
    if (field.kind != FieldKind::kLength) continue;
    const std::uint64_t said = read_bits(front, field.bit, field.bits, message.bit_order) + field.constant;
    return said < size ? kNoFrame : Size(said);
  }
  return kNoFrame;
}

Size by_type(const RadioFormat& format, Front front) {
  bool may_be = false;
  for (const Message& message : format.messages) {
    if (never_from_host(message)) continue;
    const Size size = of_message(message, front);
    if (size && *size > 0) return size;
    may_be = may_be || !size;
  }
  return may_be ? std::nullopt : kNoFrame;
}

}  // namespace

FrameBytes frames_by_tables(const RadioFormat& format, std::string_view line) {
  return [&format, line](Front front) -> Size {
    if (!line.empty() && begins_alike(front, line)) return line.size();
    if (format.framing == Framing::kCobsZero) return delimited(format, front);
    if (format.framing == Framing::kProtobuf) return std::size_t{1} + front[0];
    return format.framing == Framing::kList ? listed(format, front) : by_type(format, front);
  };
}

bool is_empty(const RadioFormat& format, Front frame) {
  const bool may_be = format.framing == Framing::kCobsZero || format.framing == Framing::kProtobuf;
  return may_be && frame.size() == 1 && frame.front() == 0;
}

}  // namespace omnihil
