// When the next loop step is due. The loop asks before every step; virtual time is counted in steps.
//
//   RealClock clock({.step_ns = 1'000'000});
//   while (clock.wait()) session.step(host, answer);      // wait() false: interrupted by a signal, look and ask again
//   clock.report().slipped_ns;
//
// FreeClock   virtual time as fast as it goes; never waits. Lateness has no meaning and stays empty.
// RealClock   step k is due at start + k * step_ns of CLOCK_MONOTONIC: absolute deadlines, so nothing drifts.
//             Lateness is the time from a step's deadline to its start. A loop that is behind runs its steps
//             without waiting until it has caught up; it may be behind by `backlog_ns` at most. What is
//             beyond that is given up: all later deadlines move ("simulated time slipped 12.3 ms against
//             wall time"), counted, never hidden.
// Timer slack is set to 1 ns: the kernel's default of 50 µs would be added to every wake-up. What is left of a wake-up
// (the timer's interrupt, the core's way out of its idle state, in a virtual machine the host's way to it) is
// saved by `spin_ns`: so long before a deadline the thread stays awake and reads the clock. It costs that share of a core.
#pragma once
#include <cstdint>
#include <string>

#include "hil/loop/clock_lateness.h"

namespace omnihil {

struct ClockReport {
  bool real_time = false;
  LatenessHistogram lateness;
  std::int64_t slipped_ns = 0;   // simulated time behind wall time for good
  std::uint64_t slips = 0;       // in how many places
  std::uint64_t late_steps = 0;  // started a whole step or more after their deadline
};

class Clock {
 public:
  virtual ~Clock() = default;
  // Returns when the next step is due: true. False: a signal came first; nothing is consumed.
  virtual bool wait() = 0;
  virtual const ClockReport& report() const = 0;
  // So much wall time is not held against the loop: a debugger held it.
  virtual void forgive(std::int64_t /*wall_ns*/) {}
};

class FreeClock : public Clock {
 public:
  bool wait() override { return true; }
  const ClockReport& report() const override { return report_; }

 private:
  ClockReport report_;
};

struct RealClockOptions {
  std::int64_t step_ns = 1'000'000;
  std::int64_t backlog_ns = 20'000'000;
  std::int64_t start_ns = 0;  // when step 0 is due, CLOCK_MONOTONIC; 0: at once
  std::int64_t spin_ns = 0;   // awake so long before each deadline; 0: asleep up to it
};

// The rule above without a clock: what RealClock does with the times it reads.
class DeadlineKeeper {
 public:
  DeadlineKeeper(const RealClockOptions& options, std::int64_t start_ns);
  std::int64_t deadline_ns() const { return deadline_ns_; }
  void forgive(std::int64_t wall_ns) { deadline_ns_ += wall_ns; }
  void begin_step(std::int64_t now_ns);  // at or after the deadline: counts, and sets the next one
  const ClockReport& report() const { return report_; }

 private:
  RealClockOptions options_;
  std::int64_t deadline_ns_;
  ClockReport report_;
};

class RealClock : public Clock {
 public:
  explicit RealClock(const RealClockOptions& options);
  bool wait() override;
  const ClockReport& report() const override { return keeper_.report(); }
  void forgive(std::int64_t wall_ns) override { keeper_.forgive(wall_ns); }

 private:
  DeadlineKeeper keeper_;
  std::int64_t spin_ns_;
};

std::int64_t monotonic_now_ns();

// SCHED_FIFO for this thread and all memory locked; empty, or why it could not be had.
std::string become_realtime(int priority);

}  // namespace omnihil
