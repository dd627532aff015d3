// Network: the league's ports, and whether a multicast packet comes back to this computer.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "hil/doctor/doctor.h"
#include "hil/league/udp_port.h"
#include "hil/loop/clock.h"
#include "hil/wire/descriptor.h"

namespace omnihil {
namespace {

constexpr std::int64_t kWait_ns = 500'000'000;  // a packet to oneself takes microseconds

sockaddr_in any_address(int port) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  return at;
}

bool takes(const Descriptor& socket, int port) {
  const sockaddr_in at = any_address(port);
  return socket.get() >= 0 && ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0;
}

Descriptor udp_socket(bool shares) {
  Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int yes = shares ? 1 : 0;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  return socket;
}

// A socket that has joined the group by the interface of that address.
bool joins(const Descriptor& socket, const std::string& group, int port, in_addr interface) {
  ip_mreq membership{};
  ::inet_pton(AF_INET, group.c_str(), &membership.imr_multiaddr);
  membership.imr_interface = interface;
  return takes(socket, port) &&
         ::setsockopt(socket.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
}

// Nothing of it leaves the computer (time to live 0), and it is empty: for whoever listens to vision here, a packet
// without content.
bool sends(const Descriptor& socket, const std::string& group, int port, in_addr interface) {
  sockaddr_in to = any_address(port);
  ::inet_pton(AF_INET, group.c_str(), &to.sin_addr);
  const int hops = 0, loop = 1;
  return takes(socket, 0) &&
         ::setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_IF, &interface, sizeof interface) == 0 &&
         ::setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_LOOP, &loop, sizeof loop) == 0 &&
         ::setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_TTL, &hops, sizeof hops) == 0 &&
         ::sendto(socket.get(), "", 0, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
}

// Real vision may be there too: only what comes from the sender's port counts.
bool comes_back(const Descriptor& listener, const Descriptor& sender) {
  sockaddr_in own{};
  socklen_t size = sizeof own;
  ::getsockname(sender.get(), reinterpret_cast<sockaddr*>(&own), &size);
  const std::int64_t until_ns = monotonic_now_ns() + kWait_ns;
  for (std::int64_t left_ns = kWait_ns; left_ns > 0; left_ns = until_ns - monotonic_now_ns()) {
    pollfd waiting{listener.get(), POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(left_ns / 1'000'000) + 1) <= 0) continue;
    char bytes[1];
    sockaddr_in from{};
    size = sizeof from;
    const auto got =
        ::recvfrom(listener.get(), bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (got >= 0 && from.sin_port == own.sin_port) return true;
  }
  return false;
}

// Why a packet to the group by that interface does not come back; empty: it does.
std::string fault_of_multicast(const std::string& group, int port, const std::string& interface) {
  in_addr address{};
  if (::inet_pton(AF_INET, interface.c_str(), &address) != 1) return "no address";
  const Descriptor listener = udp_socket(true), sender = udp_socket(false);
  if (!joins(listener, group, port, address)) return std::string("joining: ") + std::strerror(errno);
  if (!sends(sender, group, port, address)) return std::string("sending: ") + std::strerror(errno);
  return comes_back(listener, sender) ? "" : "what was sent did not come back";
}

}  // namespace

std::vector<NetworkInterface> multicast_interfaces() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return {};
  std::vector<NetworkInterface> found;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    const bool usable = (each->ifa_flags & IFF_UP) != 0 && (each->ifa_flags & IFF_MULTICAST) != 0 &&
                        (each->ifa_flags & IFF_LOOPBACK) == 0;
    if (!usable || each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN] = "";
    ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(each->ifa_addr)->sin_addr, text, sizeof text);
    found.push_back({each->ifa_name, text});
  }
  ::freeifaddrs(all);
  return found;
}

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

// The bench only sends there; an AI host beside it must be able to listen.
Finding look_at_vision_port(int port) {
  const Descriptor alone = udp_socket(false);
  if (takes(alone, port)) return {"vision port", FindingState::kOk, fmt::format("UDP {} is free", port), ""};
  const Descriptor shared = udp_socket(true);
  if (takes(shared, port))
    return {"vision port", FindingState::kOk, fmt::format("UDP {}: others listen, and share it", port), ""};
  return {"vision port", FindingState::kLimited,
          fmt::format("UDP {}: {}; no other program here can hear vision", port, std::strerror(errno)),
          fmt::format("ss -ulpn | grep {} names who holds it", port)};
}

Finding look_at_multicast(const std::string& group, int port) {
  const std::string fault = fault_of_multicast(group, port, "127.0.0.1");
  if (fault.empty())
    return {"multicast", FindingState::kOk, fmt::format("{}:{} comes back by loopback", group, port), ""};
  return {"multicast", FindingState::kMissing, fmt::format("{}:{} by loopback: {}", group, port, fault),
          "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo"};
}

Finding look_at_multicast_network(const std::string& group, int port,
                                  const std::vector<NetworkInterface>& interfaces) {
  constexpr const char* kWhat = "multicast, network";
  if (interfaces.empty()) {
    return {kWhat, FindingState::kLimited,
            "no interface beside loopback is up: vision reaches this computer only",
            "ip link show, then sudo ip link set INTERFACE up multicast on"};
  }
  std::vector<std::string> good, bad;
  for (const NetworkInterface& each : interfaces) {
    const std::string fault = fault_of_multicast(group, port, each.address);
    const std::string name = fmt::format("{} ({})", each.name, each.address);
    if (fault.empty())
      good.push_back(name);
    else
      bad.push_back(name + ": " + fault);
  }
  if (bad.empty())
    return {kWhat, FindingState::kOk, fmt::format("{}:{} by {}", group, port, fmt::join(good, ", ")), ""};
  return {kWhat, FindingState::kLimited, fmt::format("{}", fmt::join(bad, "; ")),
          fmt::format("sudo ip link set {} multicast on; or serve --vision-interface of another",
                      interfaces.front().name)};
}

}  // namespace omnihil
