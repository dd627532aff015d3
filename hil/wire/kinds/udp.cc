// UDP datagrams to a port; with listen=1 to whoever sent the last one that came; with seek=1 to a port (of a
// multicast group, say) until somebody answers, then to whoever sends, and to the port again after a second of
// silence. from=PORT: of ours that they leave from; to=PORT: of whoever sent, instead of the one that it sent from.
// Their boundaries mean nothing here: what one write() takes is one datagram, what read() gives are the bytes of all
// that came. Datagrams that the network loses are lost.
#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

#include "hil/wire/socket.h"

namespace omnihil {
namespace {

constexpr std::size_t kLargest_bytes = 65'507;  // of an IPv4 datagram: 65535 less 20 (IP) and 8 (UDP)

constexpr std::chrono::seconds kSilence{1};

class UdpWire final : public ByteWire {
 public:
  UdpWire(SocketEnd end, bool listens, int answers_to_port)
      : end_(std::move(end)), listens_(listens), answers_to_port_(answers_to_port) {}

  // A connected socket no longer takes datagrams of its peer alone.
  std::error_code seek() {
    if (::getpeername(end_.socket.get(), sought_.get(), &sought_.size) != 0) return last_error();
    const sockaddr none{.sa_family = AF_UNSPEC, .sa_data = {}};
    if (::connect(end_.socket.get(), &none, sizeof none) != 0) return last_error();
    peer_ = sought_;
    listens_ = known_ = seeks_ = true;
    return {};
  }

  std::string_view name() const override { return end_.name; }
  int handle() const override { return end_.socket.get(); }
  bool peer_present() const override { return !listens_ || known_; }

  // A datagram that does not fit whole stays with the system until its last byte has been read, so that the
  // handle is readable until then.
  std::error_code read(std::vector<std::uint8_t>& out, std::size_t limit) override {
    while (limit > 0) {
      SocketAddress sender;
      const ssize_t n = ::recvfrom(end_.socket.get(), datagram_.data(), datagram_.size(), MSG_PEEK,
                                   sender.get(), &sender.size);
      if (n < 0) return errno == EINTR || nobody_there(errno) ? std::error_code{} : last_error();
      if (listens_) peer_ = sender;
      if (listens_ && answers_to_port_ != 0) peer_.set_port(answers_to_port_);
      known_ = true;
      heard_ = std::chrono::steady_clock::now();
      const auto size = static_cast<std::size_t>(n);
      const std::size_t part = std::min(limit, size - at_);
      const auto from = datagram_.begin() + static_cast<std::ptrdiff_t>(at_);
      out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(part));
      at_ += part;
      limit -= part;
      if (at_ < size) break;
      at_ = 0;
      ::recv(end_.socket.get(), nullptr, 0, 0);  // takes it away
    }
    return {};
  }

  std::size_t write(std::span<const std::uint8_t> bytes, std::error_code& error) override {
    error.clear();
    if (!peer_present() || bytes.empty()) return 0;
    const std::span<const std::uint8_t> part = bytes.first(std::min(bytes.size(), kLargest_bytes));
    if (seeks_ && std::chrono::steady_clock::now() - heard_ > kSilence) peer_ = sought_;
    const sockaddr* to = listens_ ? peer_.get() : nullptr;
    const ssize_t n = ::sendto(end_.socket.get(), part.data(), part.size(), 0, to, listens_ ? peer_.size : 0);
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno != EINTR && !nobody_there(errno)) error = last_error();
    return 0;
  }

 private:
  // Nothing waits, or the other computer has said that nobody listens there yet.
  static bool nobody_there(int why) { return why == EAGAIN || why == ECONNREFUSED; }

  SocketEnd end_;
  bool listens_;
  int answers_to_port_;
  SocketAddress peer_;
  bool seeks_ = false;
  SocketAddress sought_;
  std::chrono::steady_clock::time_point heard_;
  bool known_ = false;  // a datagram has come
  std::array<std::uint8_t, kLargest_bytes> datagram_;
  std::size_t at_ = 0;  // bytes of the datagram that waits that have been read
};

std::unique_ptr<ByteWire> open(const WireUrl& url, WireProblem& problem) {
  const bool listens = url.number("listen") == 1;
  SocketEnd end;
  const bool seeks = url.number("seek") == 1;
  if (!open_socket_end(url, SOCK_DGRAM, listens && !seeks, end, problem, url.number("from"))) return nullptr;
  auto wire = std::make_unique<UdpWire>(std::move(end), listens, url.number("to"));
  if (!seeks) return wire;
  const std::error_code refused = wire->seek();
  if (!refused) return wire;
  problem = {url.text() + ": socket", refused};
  return nullptr;
}

}  // namespace

const WireKind& wire_udp() {
  static constexpr WireParameter kParameters[] = {
      {.name = "listen", .says = "answer to whoever sends", .usual = "0", .words = kWireNoYes},
      {.name = "seek",
       .says = "send to the address, then answer to whoever sends",
       .usual = "0",
       .words = kWireNoYes},
      {.name = "from", .says = "own port where it does not listen; 0: any", .usual = "0", .high = 65'535},
      {.name = "to",
       .says = "port of whoever sends to answer to; 0: the one it sent from",
       .usual = "0",
       .high = 65'535},
  };
  static constexpr WireKind kKind{.scheme = "udp",
                                  .says = "UDP datagrams; without a host: this computer (127.0.0.1)",
                                  .address = "[host:]port",
                                  .example = "udp:127.0.0.1:5000",
                                  .parameters = kParameters,
                                  .open_bytes = open};
  return kKind;
}

}  // namespace omnihil
