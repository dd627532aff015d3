// The two ends of a wire that turnarounds are measured over: a host that sends one command and waits for its answer, and an
// echo in a process of its own that writes back what it reads.
//
//   Times bare = echo(Wire::kUdp, command, 2000, false);
//   bare.quantile(0.99);                                     // us
#pragma once
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "hil/loop/clock.h"
#include "hil/wire/descriptor.h"

namespace omnihil {

constexpr std::int64_t kStep_ns = 1'000'000;
constexpr int kGiveUp_ms = 2'000;
constexpr int kFifoPriority = 40;  // of the host; below the bench's own

enum class Wire : bool { kUdp, kPty };

[[noreturn]] inline void die(const char* what) {
  std::perror(what);
  std::exit(2);
}

inline sockaddr_in local(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

inline Descriptor udp_to(std::uint16_t port) {
  Descriptor made(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const sockaddr_in to = local(port);
  if (::connect(made.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) die("connect");
  return made;
}

// A port that is free now; the bench opens it.
inline std::uint16_t free_port() {
  const Descriptor made(::socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in address = local(0);
  socklen_t size = sizeof address;
  if (::bind(made.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      ::getsockname(made.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0)
    die("bind");
  return ntohs(address.sin_port);
}

inline void sleep_ns(std::int64_t time_ns) {
  const timespec time{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
  ::nanosleep(&time, nullptr);
}

inline Descriptor serial_port(const std::string& path) {
  Descriptor made;
  for (int tries = 0; tries < 1'000 && !made; ++tries) {  // until the bench has made it
    made.reset(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    if (!made) sleep_ns(10'000'000);
  }
  if (!made) die(path.c_str());
  termios modes{};
  ::tcgetattr(made.get(), &modes);
  ::cfmakeraw(&modes);
  ::tcsetattr(made.get(), TCSANOW, &modes);
  return made;
}

template <class Work>
inline pid_t child(bool fifo, Work&& work) {
  const pid_t id = ::fork();
  if (id != 0) return id;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (fifo) become_realtime(kFifoPriority);
  std::_Exit(work());
}

inline int end_of(pid_t id, int number) {
  ::kill(id, number);
  int status = 0;
  ::waitpid(id, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Sends and waits for the byte that ends the answer; false when none comes.
inline bool exchange(int fd, std::span<const std::uint8_t> command, std::int64_t& sent_ns,
                     std::int64_t& came_ns) {
  sent_ns = monotonic_now_ns();
  if (::write(fd, command.data(), command.size()) != static_cast<ssize_t>(command.size())) die("write");
  std::uint8_t last = 1;
  while (last != 0) {
    pollfd wait{fd, POLLIN, 0};
    std::uint8_t bytes[256];
    if (::poll(&wait, 1, kGiveUp_ms) != 1) return false;
    const ssize_t n = ::read(fd, bytes, sizeof bytes);
    if (n <= 0) return false;
    last = bytes[n - 1];
  }
  came_ns = monotonic_now_ns();
  return true;
}

struct Times {
  std::vector<double> us;
  double quantile(double share) {
    std::sort(us.begin(), us.end());
    return us.empty() ? 0.0 : us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  }
};

// At random times within a step, so that every wait for the next one is as likely.
template <class Seen>
bool ask(int fd, std::span<const std::uint8_t> command, int count, Seen&& seen) {
  std::mt19937 random(17);
  for (int n = 0; n < count; ++n) {
    sleep_ns(kStep_ns + static_cast<std::int64_t>(random() % kStep_ns));
    std::int64_t sent_ns = 0, came_ns = 0;
    if (!exchange(fd, command, sent_ns, came_ns)) return false;
    if (n > 0) seen(sent_ns, came_ns);  // the first one wakes caches and the other side
  }
  return true;
}

inline Times echo(Wire wire, std::span<const std::uint8_t> command, int count, bool fifo) {
  Times times;
  Descriptor theirs, ours;
  if (wire == Wire::kUdp) {
    const std::uint16_t port = free_port();
    theirs.reset(::socket(AF_INET, SOCK_DGRAM, 0));
    const sockaddr_in address = local(port);
    if (::bind(theirs.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) die("bind");
    ours = udp_to(port);
  } else {
    theirs.reset(::posix_openpt(O_RDWR | O_NOCTTY));
    ::grantpt(theirs.get());
    ::unlockpt(theirs.get());
    ours = serial_port(::ptsname(theirs.get()));
  }
  const pid_t other = child(fifo, [&] {
    std::uint8_t bytes[256];
    sockaddr_in from{};
    for (;;) {
      socklen_t size = sizeof from;
      const bool udp = wire == Wire::kUdp;
      const ssize_t n =
          udp ? ::recvfrom(theirs.get(), bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from), &size)
              : ::read(theirs.get(), bytes, sizeof bytes);
      if (n <= 0) return 1;
      const auto sent = udp ? ::sendto(theirs.get(), bytes, static_cast<std::size_t>(n), 0,
                                       reinterpret_cast<sockaddr*>(&from), size)
                            : ::write(theirs.get(), bytes, static_cast<std::size_t>(n));
      if (sent != n) return 1;
    }
  });
  ask(ours.get(), command, count, [&](std::int64_t sent_ns, std::int64_t came_ns) {
    times.us.push_back(1e-3 * static_cast<double>(came_ns - sent_ns));
  });
  end_of(other, SIGKILL);
  return times;
}

}  // namespace omnihil
