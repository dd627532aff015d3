// A UDP socket of the league: many clients ask, each is answered where it asked from; or one multicast group is told.
//
//   std::string error;
//   UdpPort port = UdpPort::listen("127.0.0.1", 10301, error);
//   while (port.receive(datagram, from)) port.send(reply, from);
//   UdpPort group = UdpPort::multicast("224.5.23.2", 10006, "127.0.0.1", error);      // interface by its address
//   group.send(packet);
//
// Never blocks. IPv4, as the league uses it. A datagram that could not be sent is counted, not repeated.
#pragma once
#include <netinet/in.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "hil/wire/descriptor.h"

namespace omnihil {

class UdpPort {
 public:
  UdpPort() = default;
  // `port` 0: one that is free. `error` says what was wrong; the port is then not open.
  static UdpPort listen(const std::string& address, int port, std::string& error);
  static UdpPort multicast(const std::string& group, int port, const std::string& interface,
                           std::string& error);

  // Hears a group; other programs may hear it as well.
  static UdpPort join(const std::string& group, int port, const std::string& interface, std::string& error);

  bool is_open() const;
  int port() const;
  int handle() const { return socket_.get(); }  // readable when a datagram waits
  bool receive(std::string& bytes, sockaddr_in& from);
  void send(std::string_view bytes, const sockaddr_in& to);
  void send(std::string_view bytes) { send(bytes, group_); }
  std::uint64_t lost() const { return lost_; }

 private:
  Descriptor socket_;
  sockaddr_in group_{};
  std::uint64_t lost_ = 0;
};

}  // namespace omnihil
