// Time and limits: cores, how late this computer wakes, what it lets a program do about it.
#include <fmt/format.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "hil/doctor/doctor.h"
#include "hil/loop/clock.h"

namespace omnihil {
namespace {

constexpr double kLate_us = 1000.0;  // a loop step of serve: later than that and a step slips
constexpr std::int64_t kCoarse_ns =
    100'000;  // a tenth of a loop step; without high resolution timers it is 1 to 10 ms
constexpr int kReadings = 1000;
constexpr unsigned long kRobotsFiles = 256;  // 16 robots with a child process, wires and a recording

std::string limit_text(rlim_t limit) {
  return limit == RLIM_INFINITY ? std::string("unlimited") : std::to_string(limit);
}

}  // namespace

Finding look_at_cores(const std::string& root) {
  std::ifstream in(root + "/proc/cpuinfo");
  int cores = 0;
  for (std::string line; std::getline(in, line);) cores += line.starts_with("processor") ? 1 : 0;
  if (cores == 0) return {"cores", FindingState::kLimited, "not to be seen in /proc/cpuinfo", ""};
  return {"cores", FindingState::kOk, fmt::format("{}", cores), ""};
}

Finding look_at_clock(const std::string& root) {
  timespec step{};
  ::clock_getres(CLOCK_MONOTONIC, &step);
  std::int64_t smallest_ns = 1'000'000'000;  // between two readings that differ: what a reading costs
  std::int64_t last_ns = monotonic_now_ns();
  for (int i = 0; i < kReadings; ++i) {
    const std::int64_t now_ns = monotonic_now_ns();
    if (now_ns != last_ns) smallest_ns = std::min(smallest_ns, now_ns - last_ns);
    last_ns = now_ns;
  }
  std::string source = "unknown";
  std::ifstream(root + "/sys/devices/system/clocksource/clocksource0/current_clocksource") >> source;
  const std::int64_t resolution_ns = step.tv_sec * 1'000'000'000 + step.tv_nsec;
  const std::string detail = fmt::format("resolution {} ns, two readings {} ns apart, source {}",
                                         resolution_ns, smallest_ns, source);
  if (resolution_ns > kCoarse_ns)
    return {"clock", FindingState::kLimited, detail,
            "a kernel with high resolution timers (CONFIG_HIGH_RES_TIMERS)"};
  return {"clock", FindingState::kOk, detail, ""};
}

Finding look_at_wake_up(int sleeps) {
  std::vector<double> late_us;
  for (int i = 0; i < sleeps; ++i) {
    const timespec pause{0, 1'000'000};
    const std::int64_t before_ns = monotonic_now_ns();
    ::clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
    late_us.push_back(static_cast<double>(monotonic_now_ns() - before_ns - 1'000'000) / 1e3);
  }
  std::ranges::sort(late_us);
  if (late_us.empty()) return {"waking up", FindingState::kOk, "not measured", ""};
  const double p99 = late_us[late_us.size() * 99 / 100], median = late_us[late_us.size() / 2];
  const std::string detail =
      fmt::format("late by {:.0f} us (median), {:.0f} us (99 %), {:.0f} us (most of {} sleeps of 1 ms)",
                  median, p99, late_us.back(), late_us.size());
  if (p99 <= kLate_us) return {"waking up", FindingState::kOk, detail, ""};
  return {"waking up", FindingState::kLimited, detail, "serve --fifo, fewer programs beside it, or --step 5"};
}

Finding look_at_scheduling() {
  rlimit limit{};
  ::getrlimit(RLIMIT_RTPRIO, &limit);
  const bool root = ::geteuid() == 0;
  if (root || limit.rlim_cur > 0) {
    return {"real-time priority", FindingState::kOk,
            root ? "as root" : fmt::format("up to {}", limit_text(limit.rlim_cur)), ""};
  }
  return {"real-time priority", FindingState::kLimited, "not allowed: --fifo is refused, all else works",
          "echo \"$USER - rtprio 50\" | sudo tee /etc/security/limits.d/omnihil.conf, then log in again"};
}

Finding look_at_memory_lock() {
  rlimit limit{};
  ::getrlimit(RLIMIT_MEMLOCK, &limit);
  constexpr rlim_t kNeeded = 256u << 20;  // bytes: the program, its models and a minute of recording
  if (::geteuid() == 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= kNeeded)
    return {"locked memory", FindingState::kOk, limit_text(limit.rlim_cur) + " bytes", ""};
  return {"locked memory", FindingState::kLimited,
          fmt::format("{} bytes; --fifo wants {}", limit_text(limit.rlim_cur), kNeeded),
          "echo \"$USER - memlock unlimited\" | sudo tee -a /etc/security/limits.d/omnihil.conf, then log in "
          "again"};
}

Finding look_at_open_files() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= kRobotsFiles)
    return {"open files", FindingState::kOk, limit_text(limit.rlim_cur), ""};
  return {"open files", FindingState::kLimited, limit_text(limit.rlim_cur) + ": too few for a full team",
          fmt::format("ulimit -n {}", 4 * kRobotsFiles)};
}

}  // namespace omnihil
