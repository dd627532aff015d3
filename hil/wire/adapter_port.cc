#include "hil/wire/adapter_port.h"

#include <fmt/format.h>

#include <algorithm>

namespace omnihil {
namespace {
constexpr std::size_t kBite_bytes = 4096;
constexpr std::size_t kQueue_bytes = 65'536;  // of a host that does not read
}  // namespace

std::unique_ptr<FramePort> AdapterPort::open(const std::string& path, const std::string& scheme,
                                             std::unique_ptr<CanAdapter> adapter, std::string& problem) {
  std::unique_ptr<AdapterPort> port(new AdapterPort);
  port->transport_ = PtyTransport::open(path, problem);
  if (!port->transport_) return nullptr;
  port->url_ = scheme + ":" + path;
  port->adapter_ = std::move(adapter);
  return port;
}

bool AdapterPort::read(BusFrame& frame) {
  if (frames_.empty()) {
    bytes_.clear();
    const std::error_code error = transport_->read(bytes_, kBite_bytes);
    if (error) failure_ = url_ + ": " + error.message();
    adapter_->receive(bytes_, frames_, waiting_);
    std::reverse(frames_.begin(), frames_.end());
    if (transport_->take_host_closed()) {
      adapter_->host_closed();
      waiting_.clear();
    }
    flush();
  }
  if (frames_.empty()) return false;
  frame = frames_.back();
  frames_.pop_back();
  return true;
}

bool AdapterPort::write(const BusFrame& frame) {
  if (!transport_->host_present() || waiting_.size() > kQueue_bytes) return false;
  if (!adapter_->send(frame, waiting_)) return false;
  flush();
  return true;
}

void AdapterPort::flush() {
  if (waiting_.empty()) return;
  std::error_code error;
  const auto* data = reinterpret_cast<const std::uint8_t*>(waiting_.data());
  const std::size_t sent = transport_->write(std::span(data, waiting_.size()), error);
  if (error) failure_ = url_ + ": " + error.message();
  waiting_.erase(0, sent);
}

std::vector<std::string> AdapterPort::report() const {
  return {fmt::format("{}: {} lines that were no command or no frame", url_, adapter_->bad_lines())};
}

}  // namespace omnihil
