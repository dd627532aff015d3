#include "hil/acquire/drive_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hil/acquire/floor_need.h"

namespace omnihil {
namespace {

constexpr double kMemory = 0.5;           // of the filter: as of RealField
constexpr double kLeastBetween_s = 1e-3;  // two cameras' frames of one instant
constexpr double kResting_m_s = 0.05;     // above what a camera's millimetres make of a robot that stands
constexpr double kRest_s = 0.3;

double since_s(std::int64_t then_ns, std::int64_t now_ns) {
  return 1e-9 * static_cast<double>(now_ns - then_ns);
}

}  // namespace

void LimitWatch::told(std::int64_t now_ns, const TelemetryReading& reading) {
  heard(now_ns);
  current_A_ = 0.0;
  for (const double i : reading.motor_current_A) {
    if (std::isfinite(i)) current_A_ = std::max(current_A_, std::abs(i));
  }
  if (!std::isfinite(reading.battery_V)) return;
  battery_V_ = reading.battery_V;
  if (battery_V_ >= limits_.battery_V) {
    low_since_ns_.reset();
  } else if (!low_since_ns_) {
    low_since_ns_ = now_ns;
  }
}

void LimitWatch::seen(std::int64_t now_ns, const std::array<double, 3>& pose) {
  if (pose_ && seen_ns_) {
    const double dt_s = since_s(*seen_ns_, now_ns);
    if (dt_s < kLeastBetween_s) return;
    constexpr double kH = (1.0 - kMemory) * (1.0 - kMemory), kG = 1.0 - kMemory * kMemory;
    for (std::size_t a = 0; a < 2; ++a) {
      const double expected = (*pose_)[a] + velocity_m_s_[a] * dt_s, error = pose[a] - expected;
      velocity_m_s_[a] += kH / dt_s * error;
      (*pose_)[a] = expected + kG * error;
    }
    (*pose_)[2] = pose[2];
  } else {
    pose_ = pose;
  }
  seen_ns_ = now_ns;
  if (!moved_ns_ || speed_m_s() > kResting_m_s) moved_ns_ = now_ns;
}

void LimitWatch::begin(std::int64_t) {
  start_m_.reset();
  if (pose_) start_m_ = {(*pose_)[0], (*pose_)[1]};
  low_since_ns_.reset();
}

double LimitWatch::speed_m_s() const { return std::hypot(velocity_m_s_[0], velocity_m_s_[1]); }

bool LimitWatch::late(const std::optional<std::int64_t>& then_ns, std::int64_t now_ns) const {
  return !then_ns || since_s(*then_ns, now_ns) > limits_.silence_s;
}

std::string LimitWatch::silent(std::int64_t now_ns) const {
  const auto ago = [&](const std::optional<std::int64_t>& then_ns) {
    return then_ns
               ? fmt::format("for {:.2f} s, allowed are {:g} s", since_s(*then_ns, now_ns), limits_.silence_s)
               : std::string("at all");
  };
  if (by_.hears && late(heard_ns_, now_ns)) return "the robot has not answered " + ago(heard_ns_);
  if (by_.sees && late(seen_ns_, now_ns)) return "vision has not seen the robot " + ago(seen_ns_);
  return "";
}

std::string LimitWatch::broken(std::int64_t now_ns) const {
  if (std::string why = silent(now_ns); !why.empty()) return why;
  if (limits_.current_A > 0.0 && current_A_ > limits_.current_A)
    return fmt::format("{:.3g} A in a motor, allowed are {:g} A", current_A_, limits_.current_A);
  if (low_since_ns_ && since_s(*low_since_ns_, now_ns) >= kLasting_s)
    return fmt::format("the battery is at {:.2f} V, allowed are {:g} V", battery_V_, limits_.battery_V);
  if (!by_.sees || !pose_) return "";
  const double speed = speed_m_s();
  if (limits_.speed_m_s > 0.0 && speed > limits_.speed_m_s)
    return fmt::format("{:.2f} m/s, allowed are {:g} m/s", speed, limits_.speed_m_s);
  std::array<double, 2> stops{};
  for (std::size_t a = 0; a < 2; ++a) stops[a] = (*pose_)[a] + velocity_m_s_[a] * speed / (2.0 * kBrake_m_s2);
  if (limits_.area_m) {
    const std::array<double, 4>& l = *limits_.area_m;
    if (stops[0] < l[0] || stops[0] > l[2] || stops[1] < l[1] || stops[1] > l[3])
      return fmt::format("would come to rest at ({:.2f}, {:.2f}) m, outside of the area", stops[0], stops[1]);
  }
  if (limits_.travel_m > 0.0 && start_m_) {
    const double away = std::hypot(stops[0] - (*start_m_)[0], stops[1] - (*start_m_)[1]);
    if (away > limits_.travel_m)
      return fmt::format("would come to rest {:.2f} m from its start, allowed are {:g} m", away,
                         limits_.travel_m);
  }
  return "";
}

std::string LimitWatch::not_ready(std::int64_t now_ns) const {
  if (std::string why = silent(now_ns); !why.empty()) return why;
  if (by_.sees && since_s(moved_ns_.value_or(now_ns), now_ns) < kRest_s)
    return "the robot does not stand still";
  return broken(now_ns);
}

}  // namespace omnihil
