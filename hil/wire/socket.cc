#include "hil/wire/socket.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace omnihil {
namespace {

constexpr const char* kLoopback = "127.0.0.1";
constexpr timeval kPatience{3, 0};  // for a connection: three tries of TCP's first second

struct HostAndPort {
  std::string host = kLoopback, port;
};
HostAndPort split(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  HostAndPort parts;
  parts.port = colon == std::string::npos ? address : address.substr(colon + 1);
  if (colon != std::string::npos && colon > 0) parts.host = address.substr(0, colon);
  if (parts.host.front() == '[' && parts.host.back() == ']')
    parts.host = parts.host.substr(1, parts.host.size() - 2);
  return parts;
}

bool resolve(const WireUrl& url, int type, SocketAddress& address, WireProblem& problem) {
  const HostAndPort parts = split(url.address);
  addrinfo wanted{};
  wanted.ai_socktype = type;
  wanted.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int code = ::getaddrinfo(parts.host.c_str(), parts.port.c_str(), &wanted, &found);
  if (code != 0) {
    problem.what =
        url.text() + ": host " + parts.host + ", port \"" + parts.port + "\": " + ::gai_strerror(code);
    return false;
  }
  address.size = found->ai_addrlen;
  std::copy_n(reinterpret_cast<const char*>(found->ai_addr), address.size,
              reinterpret_cast<char*>(&address.storage));
  ::freeaddrinfo(found);
  return true;
}

std::string text_of(const std::string& scheme, int socket) {
  SocketAddress own;
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  ::getsockname(socket, own.get(), &own.size);
  ::getnameinfo(own.get(), own.size, host.data(), host.size(), port.data(), port.size(),
                NI_NUMERICHOST | NI_NUMERICSERV);
  const bool six = own.storage.ss_family == AF_INET6;
  return scheme + ":" + (six ? "[" : "") + host.data() + (six ? "]:" : ":") + port.data();
}

}  // namespace

void SocketAddress::set_port(int port) {
  const in_port_t in_order = htons(static_cast<std::uint16_t>(port));
  if (storage.ss_family == AF_INET6) {
    reinterpret_cast<sockaddr_in6*>(&storage)->sin6_port = in_order;
  } else {
    reinterpret_cast<sockaddr_in*>(&storage)->sin_port = in_order;
  }
}

bool open_socket_end(const WireUrl& url, int type, bool listen, SocketEnd& end, WireProblem& problem,
                     int own_port) {
  SocketAddress address;
  if (!resolve(url, type, address, problem)) return false;
  const auto refuse = [&](const char* step) {
    problem = {url.text() + ": " + step, last_error()};
    return false;
  };
  // Connecting waits, at most for the patience; all that follows does not block.
  end.socket.reset(::socket(address.storage.ss_family, type | SOCK_CLOEXEC, 0));
  if (!end.socket) return refuse("socket");
  const int fd = end.socket.get(), on = 1;
  if (listen) {
    ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (::bind(fd, address.get(), address.size) != 0) return refuse("bind");
    if (type == SOCK_STREAM && ::listen(fd, 1) != 0) return refuse("listen");
  } else {
    SocketAddress own;
    own.storage.ss_family = address.storage.ss_family;
    own.size = address.size;
    own.set_port(own_port);
    if (own_port != 0 && ::bind(fd, own.get(), own.size) != 0) return refuse("bind");
    ::setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
    if (::connect(fd, address.get(), address.size) != 0) return refuse("connect");
  }
  if (::fcntl(fd, F_SETFL, O_NONBLOCK) != 0) return refuse("socket");
  end.name = listen ? text_of(url.scheme, fd) : url.scheme + ":" + url.address;
  return true;
}

}  // namespace omnihil
