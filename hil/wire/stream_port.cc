#include "hil/wire/stream_port.h"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace omnihil {
namespace {

std::error_code last_error() { return {errno, std::generic_category()}; }

bool set_raw_115200(int fd) {
  termios settings{};
  if (::tcgetattr(fd, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  ::cfsetispeed(&settings, B115200);
  ::cfsetospeed(&settings, B115200);
  return ::tcsetattr(fd, TCSANOW, &settings) == 0;
}

}  // namespace

std::unique_ptr<ClientPort> ClientPort::open(const std::filesystem::path& path, std::error_code& error) {
  error.clear();
  const int fd = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) {
    error = last_error();
    return nullptr;
  }
  if (!set_raw_115200(fd)) {
    error = last_error();
    ::close(fd);
    return nullptr;
  }
  return std::unique_ptr<ClientPort>(new ClientPort(fd));
}

ClientPort::~ClientPort() { ::close(fd_); }

void ClientPort::wait(std::int64_t timeout_ns, bool to_write) const {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  pollfd entry{fd_, static_cast<short>(to_write ? POLLIN | POLLOUT : POLLIN), 0};
  const timespec timeout{timeout_ns / kSecond_ns, timeout_ns % kSecond_ns};
  ::ppoll(&entry, 1, &timeout, nullptr);
}

std::size_t ClientPort::write(std::span<const std::uint8_t> bytes, std::error_code& error) {
  const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
  if (written >= 0) return static_cast<std::size_t>(written);
  if (errno != EAGAIN && errno != EINTR) error = last_error();
  return 0;
}

void ClientPort::read(std::vector<std::uint8_t>& out, std::error_code& error) {
  std::array<std::uint8_t, 4096> buffer;
  const ssize_t count = ::read(fd_, buffer.data(), buffer.size());
  if (count > 0) out.insert(out.end(), buffer.begin(), buffer.begin() + count);
  // A hung-up line reads as its end or as EIO, a quiet one as EAGAIN.
  if (count == 0) error = std::make_error_code(std::errc::io_error);
  if (count < 0 && errno != EAGAIN && errno != EINTR) error = last_error();
}

}  // namespace omnihil
