#include "hil/loop/clock.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <time.h>

#include <cerrno>
#include <cstring>

namespace omnihil {
namespace {
constexpr std::int64_t kNsPerS = 1'000'000'000;
}

std::int64_t monotonic_now_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * kNsPerS + now.tv_nsec;
}

DeadlineKeeper::DeadlineKeeper(const RealClockOptions& options, std::int64_t start_ns)
    : options_(options), deadline_ns_(start_ns) {
  report_.real_time = true;
}

void DeadlineKeeper::begin_step(std::int64_t now_ns) {
  const std::int64_t late_ns = now_ns - deadline_ns_;
  report_.lateness.add(late_ns);
  if (late_ns >= options_.step_ns) ++report_.late_steps;
  if (late_ns > options_.backlog_ns) {
    const std::int64_t given_up_ns = late_ns - options_.backlog_ns;
    report_.slipped_ns += given_up_ns;
    ++report_.slips;
    deadline_ns_ += given_up_ns;
  }
  deadline_ns_ += options_.step_ns;
}

RealClock::RealClock(const RealClockOptions& options)
    : keeper_(options, options.start_ns != 0 ? options.start_ns : monotonic_now_ns()),
      spin_ns_(options.spin_ns) {
  ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

bool RealClock::wait() {
  const std::int64_t deadline_ns = keeper_.deadline_ns();
  std::int64_t now_ns = monotonic_now_ns();
  const std::int64_t wake_ns = deadline_ns - spin_ns_;
  if (now_ns < wake_ns) {
    const timespec until{static_cast<time_t>(wake_ns / kNsPerS), static_cast<long>(wake_ns % kNsPerS)};
    if (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) return false;
    now_ns = monotonic_now_ns();
  }
  while (now_ns < deadline_ns) now_ns = monotonic_now_ns();
  keeper_.begin_step(now_ns);
  return true;
}

std::string become_realtime(int priority) {
  const sched_param wanted{priority};
  if (::sched_setscheduler(0, SCHED_FIFO, &wanted) != 0) {
    return std::string("SCHED_FIFO refused: ") + std::strerror(errno) +
           " (needs CAP_SYS_NICE or an rtprio limit, see ulimit -r)";
  }
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    return std::string("locking memory refused: ") + std::strerror(errno) +
           " (needs CAP_IPC_LOCK or a memlock limit, see ulimit -l)";
  }
  return {};
}

}  // namespace omnihil
