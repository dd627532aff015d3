#include "hil/wire/descriptor.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace omnihil {

std::error_code last_error() { return {errno, std::generic_category()}; }

FdRead read_available(int fd, std::vector<std::uint8_t>& out, std::size_t limit) {
  FdRead got;
  while (got.bytes < limit) {
    const std::size_t old_size = out.size(), room = limit - got.bytes;
    out.resize(old_size + room);
    const ssize_t n = ::read(fd, out.data() + old_size, room);
    const int why = errno;
    out.resize(old_size + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n > 0) {
      got.bytes += static_cast<std::size_t>(n);
      continue;
    }
    if (n < 0 && why == EINTR) continue;
    got.ended = n == 0;
    if (n < 0 && why != EAGAIN) got.error = {why, std::generic_category()};
    break;
  }
  return got;
}

std::size_t write_some(int fd, std::span<const std::uint8_t> bytes, std::error_code& error, FdPut put) {
  error.clear();
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = put(fd, bytes.data() + sent, bytes.size() - sent);
    if (n > 0) {
      sent += static_cast<std::size_t>(n);
      continue;
    }
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno != EAGAIN) error = last_error();
    break;
  }
  return sent;
}

std::error_code wait_for(int fd, std::int64_t at_most_ns, bool to_write) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  pollfd watched{fd, static_cast<short>(to_write ? POLLIN | POLLOUT : POLLIN), 0};
  const timespec time{at_most_ns / kSecond_ns, at_most_ns % kSecond_ns};
  ::ppoll(&watched, 1, &time, nullptr);
  if ((watched.revents & (POLLERR | POLLNVAL)) == 0) return {};
  int why = 0;  // a socket knows more
  socklen_t size = sizeof why;
  const bool known = ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &why, &size) == 0 && why != 0;
  return {known ? why : EIO, std::generic_category()};
}

}  // namespace omnihil
