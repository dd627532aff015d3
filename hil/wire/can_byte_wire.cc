#include "hil/wire/can_byte_wire.h"

#include <algorithm>

#include "hil/wire/can_adapter.h"

namespace omnihil {
namespace {

class CanByteWire final : public ByteWire {
 public:
  CanByteWire(std::unique_ptr<FrameWire> can, bool fd) : can_(std::move(can)), fd_(fd) {}

  std::string_view name() const override { return can_->name(); }
  int handle() const override { return can_->handle(); }

  std::error_code read(std::vector<std::uint8_t>& out, std::size_t limit) override {
    while (limit > 0 && (at_ < frame_.size || next_frame())) {
      const std::size_t part = std::min<std::size_t>(limit, frame_.size - at_);
      const auto from = frame_.data.begin() + static_cast<std::ptrdiff_t>(at_);
      out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(part));
      at_ += part;
      limit -= part;
    }
    return can_->error();
  }

  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) override {
    const std::size_t most = fd_ ? 64 : 8;
    std::size_t at = 0;
    while (at < bytes.size()) {
      const std::size_t part = std::min(most, bytes.size() - at);
      BusFrame frame = can_frame(kCanToBoard, static_cast<std::uint8_t>(part));
      frame.fd = frame.bitrate_switch = fd_;
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), part, frame.data.begin());
      // padded here, with zeros: they end no frame of the stream
      if (fd_) frame.size = static_cast<std::uint8_t>(can_fd_length(can_fd_code(part)));
      if (!can_->write(frame)) break;
      at += part;
    }
    error = can_->error();
    return at;
  }

 private:
  bool next_frame() {
    while (can_->read(frame_)) {
      at_ = 0;
      if (frame_.id == kCanFromBoard && !frame_.extended && !frame_.remote && frame_.size > 0) return true;
    }
    frame_.size = 0;
    at_ = 0;
    return false;
  }

  std::unique_ptr<FrameWire> can_;
  bool fd_;
  BusFrame frame_;
  std::size_t at_ = 0;
};

}  // namespace

std::unique_ptr<ByteWire> make_can_byte_wire(std::unique_ptr<FrameWire> can, bool fd) {
  return std::make_unique<CanByteWire>(std::move(can), fd);
}

}  // namespace omnihil
