// Sockets of wires that go over the network: addresses, and sockets that never block.
//
//   SocketEnd end;
//   if (!open_socket_end(url, SOCK_STREAM, true, end, problem)) …     // url: tcp:HOST:PORT or tcp:PORT, on 127.0.0.1
#pragma once
#include <sys/socket.h>

#include <string>
#include <string_view>

#include "hil/wire/descriptor.h"
#include "hil/wire/wire_kind.h"

namespace omnihil {

struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = sizeof(sockaddr_storage);
  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  void set_port(int port);  // of an IPv4 or IPv6 address
};

// Where a socket wire begins: the address of its URL, and its socket, listening on it or connected to it.
struct SocketEnd {
  std::string name;  // "tcp:127.0.0.1:5000", with the port that the system gave where the URL says 0
  Descriptor socket;
};
// `type`: SOCK_STREAM or SOCK_DGRAM. A listening one is bound, a SOCK_STREAM one takes connections. `own_port`: of one
// that does not listen; 0: the system's choice.
bool open_socket_end(const WireUrl& url, int type, bool listen, SocketEnd& end, WireProblem& problem,
                     int own_port = 0);

}  // namespace omnihil
