#include "hil/league/league_sync.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "hil/league/league_fields.h"
#include "hil/league/messages/ssl_simulation.pb.h"

namespace omnihil {
namespace {

constexpr std::size_t kLargest = 1u << 20;  // of a request
constexpr double kLongest_s = 60.0;         // of a step
constexpr double kStepSlack = 1e-3;         // of a loop step: sim_step is a float

bool ready(int descriptor, int timeout_ms) {
  pollfd waiting{descriptor, POLLIN, 0};
  return ::poll(&waiting, 1, timeout_ms) > 0;
}

void add_error(league::RobotControlResponse& response, const char* code, const std::string& message) {
  league::SimulatorError& error = *response.add_errors();
  error.set_code(code);
  error.set_message(message);
}

}  // namespace

std::string behind_length(const std::string& bytes) {
  std::string out;
  std::size_t left = bytes.size();
  do {
    const auto low = static_cast<unsigned char>(left & 0x7f);
    left >>= 7;
    out += static_cast<char>(left > 0 ? low | 0x80 : low);
  } while (left > 0);
  return out + bytes;
}

bool take_behind_length(std::string& waiting, std::string& message, bool& bad) {
  bad = false;
  std::size_t length = 0, at = 0;
  for (;; ++at) {
    if (at == 4) {
      bad = true;
      return false;
    }
    if (at == waiting.size()) return false;
    const auto byte = static_cast<unsigned char>(waiting[at]);
    length |= static_cast<std::size_t>(byte & 0x7f) << (7 * at);
    if ((byte & 0x80) == 0) break;
  }
  if (length > kLargest) {
    bad = true;
    return false;
  }
  if (waiting.size() < at + 1 + length) return false;
  message = waiting.substr(at + 1, length);
  waiting.erase(0, at + 1 + length);
  return true;
}

bool LeagueSync::listen(const std::string& address, int port, std::string& error) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  if (::inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1) {
    error = "\"" + address + "\": allowed: an IPv4 address such as 127.0.0.1";
    return false;
  }
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int yes = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (socket.get() < 0 || ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 ||
      ::listen(socket.get(), 1) != 0) {
    error = fmt::format("TCP {}:{}: {}", address, port, std::strerror(errno));
    return false;
  }
  listener_ = std::move(socket);
  return true;
}

int LeagueSync::port() const {
  sockaddr_in at{};
  socklen_t size = sizeof at;
  if (::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&at), &size) != 0) return 0;
  return ntohs(at.sin_port);
}

bool LeagueSync::take_client(int timeout_ms) {
  if (has_client()) return true;
  if (!ready(listener_.get(), timeout_ms)) return false;
  client_ = Descriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  const int yes = 1;
  ::setsockopt(client_.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  waiting_.clear();
  return has_client();
}

bool LeagueSync::take_request(int timeout_ms) {
  for (;;) {
    bool bad = false;
    if (take_behind_length(waiting_, request_, bad)) return true;
    std::array<char, 65'536> bytes;
    if (!bad && !ready(client_.get(), timeout_ms)) return false;
    const ssize_t got = bad ? 0 : ::recv(client_.get(), bytes.data(), bytes.size(), 0);
    if (got <= 0) {
      client_ = Descriptor();
      return false;
    }
    waiting_.append(bytes.data(), static_cast<std::size_t>(got));
  }
}

void LeagueSync::answer(const std::string& bytes) {
  const std::string out = behind_length(bytes);
  for (std::size_t sent = 0; sent < out.size();) {
    const ssize_t n = ::send(client_.get(), out.data() + sent, out.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) {
      client_ = Descriptor();
      return;
    }
    sent += static_cast<std::size_t>(n);
  }
}

bool LeagueSync::serve_one(Session& session, LeagueHost& host, const std::function<void()>& step,
                           int timeout_ms) {
  if (!take_client(timeout_ms) || !take_request(timeout_ms)) return false;
  league::SimulationSyncRequest request;
  league::SimulationSyncResponse response;
  league::RobotControlResponse& robots = *response.mutable_robot_control_response();
  std::vector<LeagueError> unreadable;
  if (!read_message(request_, request, unreadable)) {
    add_error(robots, unreadable[0].code.c_str(), unreadable[0].message);
    answer(response.SerializeAsString());
    return true;
  }
  league::SimulatorResponse simulator;
  if (request.has_simulator_command())
    simulator.ParseFromString(
        host.simulator_command(request.simulator_command().SerializeAsString(), session));
  std::string refused;  // of the robots' commands; the feedback is that of after the step
  if (request.has_robot_control())
    refused = host.robot_control(request.robot_control().SerializeAsString(), host.team(), session);
  const double step_s = static_cast<double>(session.config().step_ns) / 1e9;
  const double steps = static_cast<double>(request.sim_step()) / step_s, whole = std::round(steps);
  const bool can = std::isfinite(steps) && whole >= 0.0 &&
                   std::abs(steps - whole) < kStepSlack * std::max(1.0, whole) &&
                   request.sim_step() <= kLongest_s;
  if (can) {
    for (double n = 0.0; n < whole; n += 1.0) step();
  }
  robots.ParseFromString(host.robot_control("", host.team(), session));
  if (!refused.empty()) {
    league::RobotControlResponse of_commands;
    of_commands.ParseFromString(refused);
    for (const auto& error : of_commands.errors()) *robots.add_errors() = error;
  }
  for (const auto& error : simulator.errors()) *robots.add_errors() = error;
  if (!can) {
    add_error(robots, "OUT_OF_RANGE",
              fmt::format("sim_step: found {} s, allowed: multiples of {} s up to {} s", request.sim_step(),
                          step_s, kLongest_s));
  }
  for (const std::string& frame : host.frames_now(session)) response.add_detection()->ParseFromString(frame);
  answer(response.SerializeAsString());
  return true;
}

}  // namespace omnihil
