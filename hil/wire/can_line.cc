#include "hil/wire/can_line.h"

#include <poll.h>

#include <algorithm>
#include <ctime>

#include "hil/wire/can_adapter.h"
#include "hil/wire/socketcan_port.h"

namespace omnihil {
namespace {

class CanLine final : public ByteLine {
 public:
  CanLine(std::unique_ptr<FramePort> port, bool fd) : port_(std::move(port)), fd_(fd) {}

  std::size_t read(std::span<std::uint8_t> out) override {
    std::size_t n = 0;
    while (n < out.size() && (at_ < frame_.size || next_frame())) {
      const std::size_t part = std::min<std::size_t>(out.size() - n, frame_.size - at_);
      std::copy_n(frame_.data.begin() + static_cast<std::ptrdiff_t>(at_), part,
                  out.begin() + static_cast<std::ptrdiff_t>(n));
      at_ += part;
      n += part;
    }
    return n;
  }

  // Frames that the wire does not take are lost whole, with the rest of what they belong to.
  bool write(std::span<const std::uint8_t> bytes) override {
    const std::size_t most = fd_ ? 64 : 8;
    for (std::size_t at = 0; at < bytes.size(); at += most) {
      const std::size_t part = std::min(most, bytes.size() - at);
      BusFrame frame = can_frame(kCanToBoard, static_cast<std::uint8_t>(part));
      frame.fd = frame.bitrate_switch = fd_;
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), part, frame.data.begin());
      // padded here, with zeros: a port would pad with a moteus NOP
      if (fd_) frame.size = static_cast<std::uint8_t>(can_fd_length(can_fd_code(part)));
      if (!port_->write(frame)) return false;
    }
    return true;
  }

  void wait(std::int64_t at_most_ns) override {
    pollfd watched{.fd = port_->handle(), .events = POLLIN, .revents = 0};
    const timespec time{at_most_ns / 1'000'000'000, at_most_ns % 1'000'000'000};
    ::ppoll(&watched, 1, &time, nullptr);
  }

  std::string_view failure() const override { return port_->failure(); }

 private:
  bool next_frame() {
    while (port_->read(frame_)) {
      at_ = 0;
      if (frame_.id == kCanFromBoard && !frame_.extended && !frame_.remote && frame_.size > 0) return true;
    }
    frame_.size = 0;
    at_ = 0;
    return false;
  }

  std::unique_ptr<FramePort> port_;
  bool fd_;
  BusFrame frame_;
  std::size_t at_ = 0;
};

}  // namespace

std::unique_ptr<ByteLine> make_can_line(std::unique_ptr<FramePort> port, bool fd) {
  return std::make_unique<CanLine>(std::move(port), fd);
}

std::unique_ptr<ByteLine> open_can_line(const std::string& url, std::string& problem) {
  const bool fd = url.starts_with("canfd:");
  const std::string interface = url.substr(url.find(':') + 1);
  std::unique_ptr<FramePort> port =
      open_socketcan(interface, fd ? BusCarrier::kCanFd : BusCarrier::kCan, problem);
  if (!port) return nullptr;
  return make_can_line(std::move(port), fd);
}

}  // namespace omnihil
