// A TCP connection: to a program that listens, or, with listen=1, from one client at a time; the next one waits
// until the one before has left.
#include <netinet/in.h>
#include <netinet/tcp.h>

#include <cerrno>

#include "hil/wire/socket.h"

namespace omnihil {
namespace {

// A peer that is gone is an error here, not a signal to the process.
ssize_t put(int fd, const void* data, std::size_t size) { return ::send(fd, data, size, MSG_NOSIGNAL); }

class TcpWire final : public ByteWire {
 public:
  TcpWire(SocketEnd end, bool listens) : end_(std::move(end)), listens_(listens) {
    if (!listens_) peer_ = std::move(end_.socket);
    if (peer_) send_at_once();
  }

  std::string_view name() const override { return end_.name; }
  int handle() const override { return peer_ ? peer_.get() : end_.socket.get(); }
  bool peer_present() const override { return static_cast<bool>(peer_); }
  bool take_peer_closed() override { return std::exchange(closed_, false); }

  std::error_code read(std::vector<std::uint8_t>& out, std::size_t limit) override {
    if (listens_ && !peer_) {
      peer_.reset(::accept4(end_.socket.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
      if (!peer_) return {};
      send_at_once();
    }
    const FdRead got = read_available(peer_.get(), out, limit);
    if (limit == 0 || (!got.ended && !got.error)) return {};
    if (!listens_) return got.error ? got.error : std::make_error_code(std::errc::connection_reset);
    peer_.reset();
    closed_ = true;
    return {};
  }

  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) override {
    error.clear();
    if (!peer_) return 0;
    const std::size_t sent = write_some(peer_.get(), bytes, error, put);
    if (listens_) error.clear();  // the peer is just leaving; the next read sees it
    return sent;
  }

 private:
  void send_at_once() const {
    const int on = 1;
    ::setsockopt(peer_.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }

  SocketEnd end_;  // with listen: the socket that listens
  bool listens_;
  Descriptor peer_;
  bool closed_ = false;
};

std::unique_ptr<ByteWire> open(const WireUrl& url, WireProblem& problem) {
  const bool listens = url.number("listen") == 1;
  SocketEnd end;
  if (!open_socket_end(url, SOCK_STREAM, listens, end, problem)) return nullptr;
  return std::make_unique<TcpWire>(std::move(end), listens);
}

}  // namespace

const WireKind& wire_tcp() {
  static constexpr WireParameter kParameters[] = {
      {.name = "listen", .says = "wait for the other side to connect", .usual = "0", .words = kWireNoYes},
  };
  static constexpr WireKind kKind{.scheme = "tcp",
                                  .says = "a TCP connection; without a host: this computer (127.0.0.1)",
                                  .address = "[host:]port",
                                  .example = "tcp:127.0.0.1:5000",
                                  .parameters = kParameters,
                                  .open_bytes = open};
  return kKind;
}

}  // namespace omnihil
