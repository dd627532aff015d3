// Frames of a bus that pass a port as bytes: a USB-CAN stick that is there, or that the bench plays. What the two have in common.
//
//   class StickWire final : public PortFrameWire { void poll() override; … };
#pragma once
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "hil/wire/buffered_wire.h"
#include "hil/wire/wire_kind.h"

namespace omnihil {

class PortFrameWire : public FrameWire {
 public:
  PortFrameWire(std::string name, std::unique_ptr<ByteWire> port)
      : wire_(std::move(port), kQueue_bytes), name_(std::move(name)) {}
  PortFrameWire(const PortFrameWire&) = delete;
  PortFrameWire& operator=(const PortFrameWire&) = delete;

  std::string_view name() const final { return name_; }
  std::error_code error() const final { return wire_.error(); }
  int handle() const final { return wire_.handle(); }

  bool read(BusFrame& frame) final {
    if (frames_.empty()) poll();
    if (frames_.empty()) return false;
    frame = frames_.front();
    frames_.pop_front();
    return true;
  }

 protected:
  virtual void poll() = 0;  // what waits at the port, into frames_

  const std::vector<std::uint8_t>& bytes() {
    bytes_.clear();
    wire_.read(bytes_, kBite_bytes);
    return bytes_;
  }
  bool send(std::string_view text) {
    return wire_.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }

  BufferedWire wire_;
  std::deque<BusFrame> frames_;

 private:
  static constexpr std::size_t kBite_bytes = 4096;
  static constexpr std::size_t kQueue_bytes = 65'536;  // of a peer that does not read

  std::string name_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace omnihil
