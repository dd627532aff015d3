#include "hil/wire/stick_wire.h"

#include "hil/wire/open_wire.h"
#include "hil/wire/port_frame_wire.h"

namespace omnihil {
namespace {

constexpr std::size_t kMaxLine = 256;  // the longest of either language: a frame of CAN FD

class StickWire final : public PortFrameWire {
 public:
  StickWire(std::string name, std::unique_ptr<ByteWire> port, std::unique_ptr<CanStick> stick)
      : PortFrameWire(std::move(name), std::move(port)), stick_(std::move(stick)) {
    send(stick_->open());
  }
  ~StickWire() override { send(stick_->close()); }
  StickWire(const StickWire&) = delete;
  StickWire& operator=(const StickWire&) = delete;

  bool write(const BusFrame& frame) override {
    out_.clear();
    return stick_->say(frame, out_) && send(out_);
  }

 private:
  void poll() override {
    wire_.flush();
    for (const std::uint8_t byte : bytes()) {
      if (byte != '\r' && byte != '\n' && byte != '\a') {
        if (line_.size() < kMaxLine) line_ += static_cast<char>(byte);
        continue;
      }
      BusFrame frame;
      if (stick_->hear(line_, frame)) frames_.push_back(frame);
      line_.clear();
    }
  }

  std::unique_ptr<CanStick> stick_;
  std::string line_, out_;
};

}  // namespace

std::unique_ptr<FrameWire> open_stick_wire(const WireUrl& url, std::unique_ptr<CanStick> stick,
                                           WireProblem& problem) {
  std::unique_ptr<ByteWire> port = open_byte_wire(read_wire_url("serial:" + url.address), {}, problem);
  if (!port) return nullptr;
  return std::make_unique<StickWire>(url.scheme + ":" + url.address, std::move(port), std::move(stick));
}

}  // namespace omnihil
