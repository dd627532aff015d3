#include "hil/serve/packet_feed.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hil/recording/pcap_export.h"

namespace omnihil {
namespace {

std::error_code last_error() { return {errno, std::system_category()}; }

// Whether a socket of this name is there that nobody listens to any more: left behind by a killed bench.
bool is_left_behind(const sockaddr_un& address) {
  struct stat found {};
  if (::stat(address.sun_path, &found) != 0 || !S_ISSOCK(found.st_mode)) return false;
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool alone = ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 &&
                     errno == ECONNREFUSED;
  ::close(fd);
  return alone;
}

}  // namespace

std::unique_ptr<PacketFeed> PacketFeed::open(const std::string& path, const RadioFormat& format,
                                             std::uint64_t epoch_ms, std::error_code& error) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    error = std::make_error_code(std::errc::filename_too_long);
    return nullptr;
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  if (is_left_behind(address)) ::unlink(address.sun_path);
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) {
    error = last_error();
    return nullptr;
  }
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || ::listen(fd, 8) != 0) {
    error = last_error();
    ::close(fd);
    return nullptr;
  }
  return std::unique_ptr<PacketFeed>(new PacketFeed(fd, path, format, epoch_ms));
}

PacketFeed::PacketFeed(int fd, std::string path, const RadioFormat& format, std::uint64_t epoch_ms)
    : fd_(fd), path_(std::move(path)), epoch_ms_(epoch_ms), from_host_(format), to_host_(format) {}

PacketFeed::~PacketFeed() {
  turn();
  for (const Reader& reader : readers_) ::close(reader.fd);
  ::close(fd_);
  ::unlink(path_.c_str());
}

void PacketFeed::host_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  pass(from_host_, now_ns, bytes);
}

void PacketFeed::dongle_bytes(std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  pass(to_host_, now_ns, bytes);
}

void PacketFeed::pass(FrameCutter& cutter, std::int64_t now_ns, std::span<const std::uint8_t> bytes) {
  cutter.push(bytes);
  while (const std::optional<FrameCutter::Frame> frame = cutter.next()) {
    for (Reader& reader : readers_) append_pcap_packet(reader.waiting, epoch_ms_, now_ns, frame->bytes);
  }
}

void PacketFeed::turn() {
  for (int fd = 0; (fd = ::accept4(fd_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)) >= 0;)
    readers_.push_back({fd, pcap_header()});
  std::erase_if(readers_, [](Reader& reader) {
    if (!reader.waiting.empty()) {
      const ssize_t n = ::send(reader.fd, reader.waiting.data(), reader.waiting.size(), MSG_NOSIGNAL);
      if (n > 0) reader.waiting.erase(0, static_cast<std::size_t>(n));
      if (n < 0 && errno != EAGAIN && errno != EINTR) reader.waiting.assign(kMostWaiting + 1, '\0');
    }
    const bool gone = reader.waiting.size() > kMostWaiting;
    if (gone) ::close(reader.fd);
    return gone;
  });
}

}  // namespace omnihil
