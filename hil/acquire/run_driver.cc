#include "hil/acquire/run_driver.h"

#include <cmath>
#include <utility>

namespace omnihil {

RunDriver::RunDriver(const AcquirePlan& plan, const PlanRun& run, DriveWatch& watch, std::int64_t now_ns)
    : plan_(plan),
      run_(run),
      watch_(watch),
      period_ns_(std::llround(1e9 / plan.packets_Hz)),
      begun_ns_(now_ns),
      next_ns_(now_ns) {}

void RunDriver::look(std::int64_t now_ns) {
  if (state_ == RunState::kWaiting) {
    const std::string missing = watch_.not_ready(now_ns);
    if (missing.empty()) {
      state_ = RunState::kDriving;
      start_ns_ = next_ns_;
      watch_.begin(now_ns);
    } else if (1e-9 * static_cast<double>(now_ns - begun_ns_) > kPatience_s) {
      stop(missing);
    }
  } else if (state_ == RunState::kDriving) {
    if (std::string why = watch_.broken(now_ns); !why.empty()) stop(std::move(why));
  }
}

void RunDriver::stop(std::string why) {
  if (state_ == RunState::kDone || !problem_.empty()) return;
  problem_ = std::move(why);
  if (state_ != RunState::kStopping) stops_ = 0;
  state_ = RunState::kStopping;
  stop_ns_ = next_ns_ = 0;  // at once
}

std::optional<PlannedPacket> RunDriver::due(std::int64_t now_ns) {
  if (state_ == RunState::kDone || now_ns < next_ns_) return std::nullopt;
  if (next_ns_ == 0) next_ns_ = now_ns;
  const std::int64_t at_ns = next_ns_;
  for (next_ns_ += period_ns_; next_ns_ <= now_ns; next_ns_ += period_ns_) {
    if (state_ == RunState::kDriving) ++left_out_;
  }
  if (state_ == RunState::kDriving) {
    const double at_s = 1e-9 * static_cast<double>(at_ns - start_ns_);
    if (at_s < run_.duration_s - 1e-9) return PlannedPacket{plan_value(run_, at_s), false};
    state_ = RunState::kStopping;
  }
  if (state_ == RunState::kStopping) {
    if (stop_ns_ == 0) stop_ns_ = at_ns;
    ++stops_;
    const bool rested =
        problem_.empty() ? 1e-9 * static_cast<double>(at_ns - stop_ns_) >= plan_.rest_s : true;
    if (stops_ >= kStopPackets && rested) state_ = RunState::kDone;
  }
  return PlannedPacket{{}, true};
}

}  // namespace omnihil
