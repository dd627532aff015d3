#include "hil/serve/serve_port.h"

#include <algorithm>

namespace omnihil {

LinePace carrier_pace(const Carrier& carrier) {
  if (carrier.kind != Carrier::Kind::kUart) return {};
  return {carrier.baud, carrier.bits_per_byte};
}

HostPort::HostPort(ByteWire& wire, const LinePace& pace, const HostPortOptions& options)
    : wire_(wire),
      options_(options),
      inward_(pace, options.bite_bytes),
      outward_(pace, options.queue_bytes),
      ready_(options.queue_bytes) {
  bite_.reserve(options.bite_bytes);
}

void HostPort::look_who_is_there() {
  const bool closed = wire_.take_peer_closed();
  if (closed) {
    closing_ = true;
    counts_.bytes_left_behind += outward_.waiting() + ready_.waiting();
    outward_.clear();
    ready_.clear();
  }
  const bool there = wire_.peer_present();
  if (there && (!present_ || closed)) ++counts_.hosts;
  present_ = there;
}

std::error_code HostPort::receive(std::int64_t now_ns, std::vector<std::uint8_t>& host) {
  host.clear();
  std::error_code error;
  // While a close is on its way nothing new is read: it belongs to the next host.
  if (!closing_ && inward_.room() > 0) {
    bite_.clear();
    error = wire_.read(bite_, inward_.room());
    counts_.bytes_from_host += bite_.size();
    inward_.push(bite_, now_ns);
    look_who_is_there();
  }
  inward_.pop(now_ns, host);
  return error;
}

bool HostPort::take_host_closed() {
  if (!closing_ || inward_.waiting() > 0) return false;
  closing_ = false;
  return true;
}

std::error_code HostPort::send(std::int64_t now_ns, std::span<const std::uint8_t> answer) {
  if (!present_) {
    counts_.bytes_without_host += answer.size();
    return {};
  }
  const std::size_t waiting = outward_.waiting() + ready_.waiting();
  if (waiting + answer.size() > options_.queue_bytes) {
    ++counts_.answers_dropped;
    counts_.bytes_dropped += answer.size();
  } else {
    outward_.push(answer, now_ns);
  }
  outward_.pop(now_ns, ready_.tail());
  return flush();
}

std::error_code HostPort::flush() {
  std::error_code error;
  counts_.bytes_to_host += ready_.flush(wire_, error);
  return error;
}

}  // namespace omnihil
