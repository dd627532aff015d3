#include "hil/wire/pty_transport.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace omnihil {

std::unique_ptr<PtyTransport> PtyTransport::open(const std::string& path, std::string& problem) {
  std::unique_ptr<PtyTransport> port(new PtyTransport);
  port->pty_ = Pty::open(problem);
  if (!port->pty_) return nullptr;
  problem = port->name_.claim(path, port->pty_->slave_path());
  if (!problem.empty()) return nullptr;
  port->url_ = "pty:" + path;
  return port;
}

std::error_code PtyTransport::read(std::vector<std::uint8_t>& out, std::size_t limit) {
  const Pty::Events seen = pty_->take_events();
  visited_ = visited_ || seen.visited;
  if (seen.reopened && present_) {
    closed_ = true;  // what the new host wrote comes with the next read, after the close is known
    return {};
  }
  std::size_t got = 0;
  while (got < limit) {
    const std::size_t old_size = out.size();
    out.resize(old_size + limit - got);
    const ssize_t n = ::read(pty_->master(), out.data() + old_size, limit - got);
    const int why = errno;
    out.resize(old_size + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n > 0) {
      present_ = true;
      got += static_cast<std::size_t>(n);
      continue;
    }
    if (n < 0 && why == EINTR) continue;
    if (n < 0 && why == EIO) return host_left();
    if (n == 0 || why == EAGAIN) {
      present_ = true;  // no EIO: somebody has the slave open
      return {};
    }
    return {why, std::generic_category()};
  }
  return {};
}

// No host has the slave open and all it wrote was read. The line is made fresh for the next one; where the
// last one left it locked, a new pty takes its place under the same name.
std::error_code PtyTransport::host_left() {
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

std::size_t PtyTransport::write(std::span<const std::uint8_t> bytes, std::error_code& error) {
  error.clear();
  if (!present_) return 0;
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = ::write(pty_->master(), bytes.data() + sent, bytes.size() - sent);
    if (n > 0) {
      sent += static_cast<std::size_t>(n);
      continue;
    }
    if (n < 0 && errno == EINTR) continue;
    if (n == 0 || errno == EAGAIN || errno == EIO) break;  // full, or the host is just leaving
    error = {errno, std::generic_category()};
    break;
  }
  return sent;
}

bool PtyTransport::take_host_closed() {
  const bool closed = closed_;
  closed_ = false;
  return closed;
}

}  // namespace omnihil
