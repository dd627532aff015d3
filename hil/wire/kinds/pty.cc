// A pseudo-terminal that we offer under a name: whoever opens it finds a serial port.
#include <cerrno>

#include "hil/wire/descriptor.h"
#include "hil/wire/pty_wire.h"
#include "hil/wire/wire_kind.h"

namespace omnihil {

std::unique_ptr<PtyWire> PtyWire::open(const std::string& path, std::string& problem) {
  std::unique_ptr<PtyWire> port(new PtyWire);
  port->pty_ = Pty::open(problem);
  if (!port->pty_) return nullptr;
  problem = port->name_.claim(path, port->pty_->slave_path());
  if (!problem.empty()) return nullptr;
  port->label_ = "pty:" + path;
  return port;
}

std::error_code PtyWire::read(std::vector<std::uint8_t>& out, std::size_t limit) {
  const Pty::Events seen = pty_->take_events();
  visited_ = visited_ || seen.visited;
  if (seen.reopened && present_) {
    closed_ = true;  // what the new host wrote comes with the next read, after the close is known
    return {};
  }
  const FdRead got = read_available(pty_->master(), out, limit);
  if (got.error == std::errc::io_error) {
    if (got.bytes > 0) present_ = true;
    return host_left();
  }
  if (got.error) return got.error;
  if (limit > 0) present_ = true;  // no EIO: somebody has the slave open
  return {};
}

// No host has the slave open and all it wrote was read. The line is made fresh for the next one; where the
// last one left it locked, a new pty takes its place under the same name.
std::error_code PtyWire::host_left() {
  if (!present_ && !visited_) return {};
  present_ = false;
  visited_ = false;
  closed_ = true;
  if (pty_->reset_line()) return {};
  std::string problem;
  std::unique_ptr<Pty> fresh = Pty::open(problem);
  if (!fresh || !name_.point_to(fresh->slave_path())) return {EIO, std::generic_category()};
  pty_ = std::move(fresh);
  return {};
}

std::size_t PtyWire::write(std::span<const std::uint8_t> bytes, std::error_code& error) {
  error.clear();
  if (!present_) return 0;
  const std::size_t sent = write_some(pty_->master(), bytes, error);
  if (error == std::errc::io_error) error.clear();  // the host is just leaving
  return sent;
}

const WireKind& wire_pty() {
  static constexpr WireKind kKind{
      .scheme = "pty",
      .says = "a pseudo-terminal that is offered under this name; whoever opens it finds a serial port",
      .address = "name",
      .example = "pty:./dongle",
      .open_bytes = [](const WireUrl& url, WireProblem& problem) -> std::unique_ptr<ByteWire> {
        return PtyWire::open(url.address, problem.what);
      }};
  return kKind;
}

}  // namespace omnihil
