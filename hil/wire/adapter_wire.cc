#include "hil/wire/adapter_wire.h"

#include <fmt/format.h>

#include <algorithm>

#include "hil/wire/buffered_wire.h"
#include "hil/wire/pty_wire.h"

namespace omnihil {
namespace {

constexpr std::size_t kBite_bytes = 4096;
constexpr std::size_t kQueue_bytes = 65'536;  // of a host that does not read

class AdapterWire final : public FrameWire {
 public:
  AdapterWire(std::string name, std::unique_ptr<ByteWire> wire, std::unique_ptr<CanAdapter> adapter)
      : name_(std::move(name)), wire_(std::move(wire), kQueue_bytes), adapter_(std::move(adapter)) {}

  std::string_view name() const override { return name_; }
  std::error_code error() const override { return wire_.error(); }
  int handle() const override { return wire_.handle(); }

  bool read(BusFrame& frame) override {
    if (frames_.empty()) poll();
    if (frames_.empty()) return false;
    frame = frames_.back();
    frames_.pop_back();
    return true;
  }

  bool write(const BusFrame& frame) override {
    if (!wire_.peer_present()) return false;
    line_.clear();
    return adapter_->send(frame, line_) && send(line_);
  }

  std::vector<std::string> report() const override {
    return {fmt::format("{}: {} lines that were no command or no frame", name_, adapter_->bad_lines())};
  }

 private:
  void poll() {
    bytes_.clear();
    line_.clear();
    wire_.read(bytes_, kBite_bytes);
    adapter_->receive(bytes_, frames_, line_);
    std::reverse(frames_.begin(), frames_.end());
    if (wire_.take_peer_closed()) {
      adapter_->host_closed();
      wire_.clear();
    } else {
      send(line_);
    }
  }

  bool send(std::string_view text) {
    return wire_.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }

  std::string name_;
  BufferedWire wire_;
  std::unique_ptr<CanAdapter> adapter_;
  std::vector<std::uint8_t> bytes_;
  std::vector<BusFrame> frames_;  // in reverse: the next one is the last
  std::string line_;              // of the adapter to its host
};

}  // namespace

std::unique_ptr<FrameWire> open_adapter_wire(const WireUrl& url, std::unique_ptr<CanAdapter> adapter,
                                             WireProblem& problem) {
  std::unique_ptr<ByteWire> pty = PtyWire::open(url.address, problem.what);
  if (!pty) return nullptr;
  return std::make_unique<AdapterWire>(url.scheme + ":" + url.address, std::move(pty), std::move(adapter));
}

}  // namespace omnihil
