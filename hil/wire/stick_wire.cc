#include "hil/wire/stick_wire.h"

#include <deque>

#include "hil/wire/buffered_wire.h"
#include "hil/wire/open_wire.h"

namespace omnihil {
namespace {

constexpr std::size_t kBite_bytes = 4096;
constexpr std::size_t kQueue_bytes = 65'536;
constexpr std::size_t kMaxLine = 256;  // the longest of either language: a frame of CAN FD

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class StickWire final : public FrameWire {
 public:
  StickWire(std::string name, std::unique_ptr<ByteWire> wire, std::unique_ptr<CanStick> stick)
      : name_(std::move(name)), wire_(std::move(wire), kQueue_bytes), stick_(std::move(stick)) {
    wire_.write(bytes_of(stick_->open()));
  }
  ~StickWire() override { wire_.write(bytes_of(stick_->close())); }
  StickWire(const StickWire&) = delete;
  StickWire& operator=(const StickWire&) = delete;

  std::string_view name() const override { return name_; }
  std::error_code error() const override { return wire_.error(); }
  int handle() const override { return wire_.handle(); }

  bool read(BusFrame& frame) override {
    if (frames_.empty()) poll();
    if (frames_.empty()) return false;
    frame = frames_.front();
    frames_.pop_front();
    return true;
  }

  bool write(const BusFrame& frame) override {
    out_.clear();
    return stick_->say(frame, out_) && wire_.write(bytes_of(out_));
  }

 private:
  void poll() {
    bytes_.clear();
    wire_.flush();
    wire_.read(bytes_, kBite_bytes);
    for (const std::uint8_t byte : bytes_) {
      if (byte != '\r' && byte != '\n' && byte != '\a') {
        if (line_.size() < kMaxLine) line_ += static_cast<char>(byte);
        continue;
      }
      BusFrame frame;
      if (stick_->hear(line_, frame)) frames_.push_back(frame);
      line_.clear();
    }
  }

  std::string name_;
  BufferedWire wire_;
  std::unique_ptr<CanStick> stick_;
  std::vector<std::uint8_t> bytes_;
  std::string line_, out_;
  std::deque<BusFrame> frames_;
};

}  // namespace

std::unique_ptr<FrameWire> open_stick_wire(const WireUrl& url, std::unique_ptr<CanStick> stick,
                                           WireProblem& problem) {
  std::unique_ptr<ByteWire> port = open_byte_wire(read_wire_url("serial:" + url.address), {}, problem);
  if (!port) return nullptr;
  return std::make_unique<StickWire>(url.scheme + ":" + url.address, std::move(port), std::move(stick));
}

}  // namespace omnihil
