#include "hil/league/udp_port.h"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace omnihil {
namespace {

constexpr std::size_t kLargest = 65'536;  // of a datagram

bool address_of(const std::string& text, int port, sockaddr_in& out, std::string& error) {
  out = {};
  out.sin_family = AF_INET;
  out.sin_port = htons(static_cast<std::uint16_t>(port));
  if (::inet_pton(AF_INET, text.c_str(), &out.sin_addr) == 1) return true;
  error = "\"" + text + "\": allowed: an IPv4 address such as 127.0.0.1";
  return false;
}

Descriptor open_socket(std::string& error) {
  Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.get() < 0) error = std::string("socket: ") + std::strerror(errno);
  return socket;
}

}  // namespace

UdpPort UdpPort::listen(const std::string& address, int port, std::string& error) {
  UdpPort out;
  sockaddr_in at{};
  if (!address_of(address, port, at, error)) return out;
  Descriptor socket = open_socket(error);
  if (socket.get() < 0) return out;
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) {
    error = "UDP " + address + ":" + std::to_string(port) + ": " + std::strerror(errno);
    return out;
  }
  out.socket_ = std::move(socket);
  return out;
}

UdpPort UdpPort::multicast(const std::string& group, int port, const std::string& interface,
                           std::string& error) {
  UdpPort out;
  sockaddr_in via{};
  if (!address_of(group, port, out.group_, error) || !address_of(interface, 0, via, error)) return out;
  Descriptor socket = open_socket(error);
  if (socket.get() < 0) return out;
  const unsigned char loop = 1, hops = 1;  // clients of this computer too; not beyond the next router
  const bool set =
      ::setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_IF, &via.sin_addr, sizeof via.sin_addr) == 0 &&
      ::setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_LOOP, &loop, sizeof loop) == 0 &&
      ::setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_TTL, &hops, sizeof hops) == 0;
  if (!set) {
    error = "multicast by interface " + interface + ": " + std::strerror(errno);
    return out;
  }
  out.socket_ = std::move(socket);
  return out;
}

UdpPort UdpPort::join(const std::string& group, int port, const std::string& interface, std::string& error) {
  UdpPort out;
  sockaddr_in at{}, via{};
  if (!address_of(group, port, at, error) || !address_of(interface, 0, via, error)) return out;
  Descriptor socket = open_socket(error);
  if (socket.get() < 0) return out;
  const int yes = 1;
  ip_mreq membership{};
  membership.imr_multiaddr = at.sin_addr;
  membership.imr_interface = via.sin_addr;
  // Bound to the group itself: what other groups send to this port is not ours.
  const bool set =
      ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
      ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0 &&
      ::setsockopt(socket.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
  if (!set) {
    error = "multicast " + group + ":" + std::to_string(port) + " by interface " + interface + ": " +
            std::strerror(errno);
    return out;
  }
  out.socket_ = std::move(socket);
  return out;
}

bool UdpPort::is_open() const { return socket_.get() >= 0; }

int UdpPort::port() const {
  sockaddr_in at{};
  socklen_t size = sizeof at;
  if (::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&at), &size) != 0) return 0;
  return ntohs(at.sin_port);
}

bool UdpPort::receive(std::string& bytes, sockaddr_in& from) {
  bytes.resize(kLargest);
  socklen_t size = sizeof from;
  const ssize_t got =
      ::recvfrom(socket_.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
  if (got < 0) return false;
  bytes.resize(static_cast<std::size_t>(got));
  return true;
}

void UdpPort::send(std::string_view bytes, const sockaddr_in& to) {
  const ssize_t sent = ::sendto(socket_.get(), bytes.data(), bytes.size(), 0,
                                reinterpret_cast<const sockaddr*>(&to), sizeof to);
  if (sent != static_cast<ssize_t>(bytes.size())) ++lost_;
}

}  // namespace omnihil
