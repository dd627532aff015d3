#include "hil/wire/adapter_wire.h"

#include <fmt/format.h>

#include "hil/wire/port_frame_wire.h"
#include "hil/wire/pty_wire.h"

namespace omnihil {
namespace {

class AdapterWire final : public PortFrameWire {
 public:
  AdapterWire(std::string name, std::unique_ptr<ByteWire> pty, std::unique_ptr<CanAdapter> adapter)
      : PortFrameWire(std::move(name), std::move(pty)), adapter_(std::move(adapter)) {}

  bool write(const BusFrame& frame) override {
    if (!wire_.peer_present()) return false;
    line_.clear();
    return adapter_->send(frame, line_) && send(line_);
  }

  std::vector<std::string> report() const override {
    return {fmt::format("{}: {} lines that were no command or no frame", name(), adapter_->bad_lines())};
  }

 private:
  void poll() override {
    line_.clear();
    heard_.clear();
    adapter_->receive(bytes(), heard_, line_);
    frames_.assign(heard_.begin(), heard_.end());
    if (wire_.take_peer_closed()) {
      adapter_->host_closed();
      wire_.clear();
    } else {
      send(line_);
    }
  }

  std::unique_ptr<CanAdapter> adapter_;
  std::vector<BusFrame> heard_;
  std::string line_;  // of the adapter to its host
};

}  // namespace

std::unique_ptr<FrameWire> open_adapter_wire(const WireUrl& url, std::unique_ptr<CanAdapter> adapter,
                                             WireProblem& problem) {
  std::unique_ptr<ByteWire> pty = PtyWire::open(url.address, problem.what);
  if (!pty) return nullptr;
  return std::make_unique<AdapterWire>(url.scheme + ":" + url.address, std::move(pty), std::move(adapter));
}

}  // namespace omnihil
