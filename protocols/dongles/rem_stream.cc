#include "protocols/dongles/rem_stream.h"

#include <algorithm>
#include <cassert>

namespace omnihil {

RemStream::RemStream(const RadioFormat& format, PacketCounts& counts) : format_(format), counts_(counts) {
  const Message* header = message_of_role(format.messages, MessageRole::kHeaderOnly);
  const Message* filler = message_of_role(format.messages, MessageRole::kFiller);
  assert(header != nullptr && filler != nullptr);
  header_bytes_ = static_cast<std::size_t>(header->size_bytes);
  const int version = header->field_index("remVersion");
  assert(version >= 0);
  version_ = static_cast<std::uint8_t>(header->fields[static_cast<std::size_t>(version)].constant);
  filler_type_ = static_cast<std::uint8_t>(filler->type);
  filler_bytes_ = static_cast<std::size_t>(filler->size_bytes);
}

void RemStream::expire(std::int64_t now_ns) {
  if (fill_ > 0 && now_ns - last_byte_ns_ >= kHalfPacket_ns) close();
}

void RemStream::close() {
  if (fill_ > 0) counts_.count(PacketError::kTooShort);
  fill_ = 0;
  wanted_ = 1;
}

PacketError RemStream::take_refusal() {
  const PacketError refusal = refusal_;
  refusal_ = PacketError::kNone;
  return refusal;
}

void RemStream::begin_transfer(std::int64_t now_ns) {
  if (now_ns < transfer_end_ns_) return;
  transfer_end_ns_ = now_ns + kTransfer_ns;
  discarding_ = false;
}

std::span<const std::uint8_t> RemStream::take(std::span<const std::uint8_t> bytes) {
  const std::size_t n = std::min(bytes.size(), wanted_ - fill_);
  std::copy_n(bytes.begin(), n, buffer_.begin() + static_cast<std::ptrdiff_t>(fill_));
  fill_ += n;
  return bytes.subspan(n);
}

// The order of the checks is the base station's: filler, version, type, size.
bool RemStream::header_is_good() {
  const bool filler = buffer_[0] == filler_type_;
  const std::size_t head = filler ? filler_bytes_ : header_bytes_;
  if (fill_ < head) {
    wanted_ = head;
    return true;
  }
  if (filler) return true;
  if (buffer_[3] >> 4 != version_) return refuse(PacketError::kVersion), false;
  const Message* message = message_of_type(format_.messages, buffer_[0]);
  if (message == nullptr) return refuse(PacketError::kUnknownType), false;
  const std::size_t size = packet_bytes(buffer_);
  const auto fields = static_cast<std::size_t>(message->size_bytes);
  if (message->text_tail ? size < fields : size != fields) return refuse(PacketError::kLength), false;
  wanted_ = size;
  return true;
}

void RemStream::refuse(PacketError error) {
  counts_.count(error);
  refusal_ = error;
  discarding_ = true;
  fill_ = 0;
  wanted_ = 1;
}

}  // namespace omnihil
