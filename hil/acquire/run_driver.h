// One run of a plan, packet by packet: when what is asked, and the stop that ends it, whatever happens.
//
//   RunDriver driver(plan, plan.runs[0], watch, now_ns);
//   while (driver.state() != RunState::kDone) {
//     driver.look(now_ns);                                        // limits
//     if (std::optional<PlannedPacket> p = driver.due(now_ns)) send(p->value);
//     wait_until(driver.next_ns());
//   }
//   driver.problem();                                             // empty: it ran to its end
//
// Waiting: zero is asked at the plan's rate until the robot answers, is seen and stands; kPatience_s at most. Driving: packet
// k is due at start + k / packets_Hz and asks what the plan has then; one that is late by a period is left out. Stopping: zero at
// once, then at the plan's rate for rest_s, after a fault kStopPackets of them at least: one may be lost on the air.
// stop() makes the next due() a stop packet whenever it comes.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "hil/acquire/acquire_plan.h"
#include "hil/acquire/drive_limits.h"

namespace omnihil {

enum class RunState : std::uint8_t { kWaiting, kDriving, kStopping, kDone };

struct PlannedPacket {
  std::array<double, kWheels> value{};
  bool stop = false;  // behind the run, or before it
};

class RunDriver {
 public:
  static constexpr double kPatience_s = 10.0;
  static constexpr int kStopPackets = 5;  // all lost at 10 % of loss: once in 1e5

  RunDriver(const AcquirePlan& plan, const PlanRun& run, DriveWatch& watch, std::int64_t now_ns);

  void look(std::int64_t now_ns);
  void stop(std::string why);
  std::optional<PlannedPacket> due(std::int64_t now_ns);

  RunState state() const { return state_; }
  std::int64_t next_ns() const { return next_ns_; }  // of the next packet
  const std::string& problem() const { return problem_; }
  std::int64_t driving_from_ns() const { return start_ns_; }
  int left_out() const { return left_out_; }  // packets that were too late

 private:
  const AcquirePlan& plan_;
  const PlanRun& run_;
  DriveWatch& watch_;
  std::int64_t period_ns_, begun_ns_, next_ns_, start_ns_ = 0, stop_ns_ = 0;
  RunState state_ = RunState::kWaiting;
  int stops_ = 0, left_out_ = 0;
  std::string problem_;
};

}  // namespace omnihil
