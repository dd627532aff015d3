#include "hil/wire/buffered_wire.h"

#include "hil/wire/descriptor.h"

namespace omnihil {

bool BufferedWire::write(std::span<const std::uint8_t> message) {
  flush();
  if (queue_.waiting() > 0) {
    if (queue_.waiting() + message.size() > queue_bytes_) return false;
    queue_.append(message);
    return !error_;
  }
  std::error_code error;
  const std::span<const std::uint8_t> rest = message.subspan(wire_->write(message, error));
  note(error);
  if (rest.size() > queue_bytes_) return false;
  queue_.append(rest);
  return !error_;
}

void BufferedWire::flush() {
  std::error_code error;
  queue_.flush(*wire_, error);
  note(error);
}

void BufferedWire::wait(std::int64_t at_most_ns) { note(wait_for(wire_->handle(), at_most_ns, false)); }

void BufferedWire::note(std::error_code error) {
  if (!error || error_) return;
  error_ = error;
  failure_ = std::string(wire_->name()) + ": " + error.message();
}

}  // namespace omnihil
