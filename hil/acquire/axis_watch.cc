#include "hil/acquire/axis_watch.h"

#include <fmt/format.h>

#include <cmath>

namespace omnihil {
namespace {

constexpr double kMemory = 0.5;  // of the filter: as of LimitWatch
constexpr double kResting_rad_s =
    1.0;  // a count of 1024 within 5 ms at an output: above what a counter makes of rest
constexpr double kRest_s = 0.3;  // as of LimitWatch

double since_s(std::int64_t then_ns, std::int64_t now_ns) {
  return 1e-9 * static_cast<double>(now_ns - then_ns);
}

}  // namespace

void AxisWatch::told(const AxisMoment& r) {
  if (std::isfinite(r.velocity_rad_s)) {
    velocity_rad_s_ = r.velocity_rad_s;
  } else if (last_ && r.time_s > last_->time_s) {
    const double seen = (r.position_rad - last_->position_rad) / (r.time_s - last_->time_s);
    velocity_rad_s_ += (1.0 - kMemory) * (seen - velocity_rad_s_);
  }
  if (!(r.bus_V < limits_.battery_V)) {
    low_since_ns_.reset();
  } else if (!low_since_ns_) {
    low_since_ns_ = r.now_ns;
  }
  if (!moved_ns_ || std::abs(velocity_rad_s_) > kResting_rad_s) moved_ns_ = r.now_ns;
  last_ = r;
}

void AxisWatch::begin(std::int64_t) {
  start_rad_.reset();
  if (last_) start_rad_ = last_->position_rad;
  low_since_ns_.reset();
}

std::string AxisWatch::broken(std::int64_t now_ns) const {
  if (!trouble_.empty()) return trouble_;
  if (!last_) return "the axis has not answered at all";
  if (since_s(last_->now_ns, now_ns) > limits_.silence_s)
    return fmt::format("the axis has not answered for {:.2f} s, allowed are {:g} s",
                       since_s(last_->now_ns, now_ns), limits_.silence_s);
  if (limits_.current_A > 0.0 && std::abs(last_->current_A) > limits_.current_A)
    return fmt::format("{:.3g} A, allowed are {:g} A", last_->current_A, limits_.current_A);
  if (low_since_ns_ && since_s(*low_since_ns_, now_ns) >= LimitWatch::kLasting_s)
    return fmt::format("the supply is at {:.2f} V, allowed are {:g} V", last_->bus_V, limits_.battery_V);
  if (limits_.speed_rad_s > 0.0 && std::abs(velocity_rad_s_) > limits_.speed_rad_s)
    return fmt::format("{:.4g} rad/s, allowed are {:g} rad/s", velocity_rad_s_, limits_.speed_rad_s);
  if (limits_.travel_rad > 0.0 && start_rad_ &&
      std::abs(last_->position_rad - *start_rad_) > limits_.travel_rad)
    return fmt::format("{:.4g} rad from its start, allowed are {:g} rad", last_->position_rad - *start_rad_,
                       limits_.travel_rad);
  return "";
}

std::string AxisWatch::not_ready(std::int64_t now_ns) const {
  if (std::string why = broken(now_ns); !why.empty()) return why;
  if (since_s(moved_ns_.value_or(now_ns), now_ns) < kRest_s) return "the axis does not stand still";
  return "";
}

}  // namespace omnihil
