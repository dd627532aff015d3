#include "hil/recording/stream_frames.h"

#include <algorithm>

#include "protocols/packet_list.h"

namespace omnihil {

void FrameCutter::push(std::span<const std::uint8_t> bytes) {
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(front_));
  front_ = 0;
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
}

std::size_t FrameCutter::frame_length() const {
  const auto rest = std::span(waiting_).subspan(front_);
  const std::size_t longest = std::min(rest.size(), static_cast<std::size_t>(format_.max_frame_bytes));
  for (std::size_t length = 1; length <= longest; ++length) {
    if (is_frame(format_, rest.first(length))) return length;
  }
  return 0;
}

FrameCutter::Frame FrameCutter::take(std::size_t count, bool understood) {
  const auto first = waiting_.begin() + static_cast<std::ptrdiff_t>(front_);
  Frame frame{.offset = offset_,
              .bytes = {first, first + static_cast<std::ptrdiff_t>(count)},
              .understood = understood};
  front_ += count;
  offset_ += count;
  return frame;
}

std::optional<FrameCutter::Frame> FrameCutter::next() {
  const std::size_t start = front_;
  std::size_t skipped = 0;
  while (front_ < waiting_.size()) {
    if (const std::size_t length = frame_length(); length > 0) {
      if (skipped == 0) return take(length, true);
      break;  // the damaged bytes first, the frame at the next call
    }
    const bool may_still_come = waiting_.size() - front_ < static_cast<std::size_t>(format_.max_frame_bytes);
    if (may_still_come && !finished_) break;
    ++skipped;
    ++front_;
  }
  front_ = start;
  if (skipped == 0) return std::nullopt;
  return take(skipped, false);
}

}  // namespace omnihil
