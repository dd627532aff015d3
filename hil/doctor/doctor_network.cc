// Network: the league's ports, and whether a multicast packet comes back to this computer.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "hil/doctor/doctor.h"
#include "hil/league/udp_port.h"
#include "hil/wire/descriptor.h"

namespace omnihil {
namespace {

constexpr int kWait_ms = 500;  // a packet to oneself takes microseconds

// A socket that has joined the group by loopback; not open with the reason in `error`.
Descriptor joined(const std::string& group, int port, std::string& error) {
  Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  ip_mreq membership{};
  ::inet_pton(AF_INET, group.c_str(), &membership.imr_multiaddr);
  membership.imr_interface.s_addr = htonl(INADDR_LOOPBACK);
  if (socket.get() >= 0 && ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0 &&
      ::setsockopt(socket.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0)
    return socket;
  error = std::strerror(errno);
  return Descriptor();
}

}  // namespace

Finding look_at_league_ports(const std::vector<int>& ports) {
  std::vector<int> taken;
  for (const int port : ports) {
    std::string error;
    if (!UdpPort::listen("127.0.0.1", port, error).is_open()) taken.push_back(port);
  }
  if (taken.empty())
    return {"league ports", FindingState::kOk, fmt::format("UDP {} are free", fmt::join(ports, ", ")), ""};
  return {"league ports", FindingState::kLimited,
          fmt::format("UDP {} taken by another program", fmt::join(taken, ", ")),
          fmt::format("ss -ulpn | grep -E '{}' names it; or serve --league-control-port, --league-robot-port",
                      fmt::join(taken, "|"))};
}

Finding look_at_multicast(const std::string& group, int port) {
  std::string error;
  const Descriptor listener = joined(group, port, error);
  UdpPort sender;
  if (listener.get() >= 0) sender = UdpPort::multicast(group, port, "127.0.0.1", error);
  if (!sender.is_open()) {
    return {"multicast", FindingState::kMissing, fmt::format("{}:{} by loopback: {}", group, port, error),
            "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo"};
  }
  sender.send("omnihil doctor");
  pollfd waiting{listener.get(), POLLIN, 0};
  if (::poll(&waiting, 1, kWait_ms) > 0)
    return {"multicast", FindingState::kOk, fmt::format("{}:{} comes back by loopback", group, port), ""};
  return {"multicast", FindingState::kMissing,
          fmt::format("{}:{}: what was sent did not come back", group, port),
          "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo"};
}

}  // namespace omnihil
