#include "hil/serve/extcap_capture.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "hil/wire/descriptor.h"

namespace omnihil {
namespace {

constexpr int kAskAgain_ms = 100;  // whether a bench is there, or the reader is gone

// Nobody reads the pipe any more.
bool reader_gone(const Descriptor& pipe, int wait_ms) {
  pollfd asked{.fd = pipe.get(), .events = 0, .revents = 0};
  ::poll(&asked, 1, wait_ms);
  return (asked.revents & POLLERR) != 0;
}

// False when there can be no bench behind this name.
bool connect_to(const sockaddr_un& address, Descriptor& bench) {
  bench = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::connect(bench.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return true;
  const int why = errno;
  bench = Descriptor();
  errno = why;
  return why == ENOENT || why == ECONNREFUSED || why == EAGAIN;
}

bool write_all(const Descriptor& pipe, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::write(pipe.get(), data, size);
    if (n < 0 && errno != EINTR) return false;
    if (n > 0) data += n, size -= static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

ExtcapEnd copy_capture(const std::string& socket, const std::string& pipe_name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket.size() >= sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    return ExtcapEnd::kNoSocket;
  }
  std::memcpy(address.sun_path, socket.c_str(), socket.size() + 1);
  std::signal(SIGPIPE, SIG_IGN);
  const Descriptor pipe(::open(pipe_name.c_str(), O_WRONLY | O_CLOEXEC));
  if (!pipe) return ExtcapEnd::kNoPipe;
  Descriptor bench;
  while (!bench) {
    if (!connect_to(address, bench)) return ExtcapEnd::kNoSocket;
    if (!bench && reader_gone(pipe, kAskAgain_ms)) return ExtcapEnd::kDone;
  }
  std::array<char, 65536> buffer;
  for (;;) {
    pollfd asked{.fd = bench.get(), .events = POLLIN, .revents = 0};
    ::poll(&asked, 1, kAskAgain_ms);
    if (reader_gone(pipe, 0)) return ExtcapEnd::kDone;
    if (asked.revents == 0) continue;
    const ssize_t n = ::read(bench.get(), buffer.data(), buffer.size());
    if (n == 0 || (n < 0 && errno != EINTR)) return ExtcapEnd::kDone;
    if (n > 0 && !write_all(pipe, buffer.data(), static_cast<std::size_t>(n))) return ExtcapEnd::kDone;
  }
}

}  // namespace omnihil
