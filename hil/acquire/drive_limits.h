// Whether a robot that is driven may be driven on: what its telemetry and the cameras say, against the plan's limits.
//
//   LimitWatch watch(plan.limits, {.hears = true, .sees = true});
//   watch.told(now_ns, reading);  watch.seen(now_ns, {x_m, y_m, yaw_rad});
//   watch.begin(now_ns);                                        // a run: travel is counted from here
//   if (const std::string why = watch.broken(now_ns); !why.empty()) stop(why);
//
// Area and travel count the way that it takes to stop, v^2 / (2 kBrake_m_s2) along the speed that vision shows. A battery is too
// low when it stays so for kLasting_s: a start dips it. Silence: nothing heard (where the robot answers), nothing seen (where
// vision is taken). Speeds by a fading-memory filter as of hil/league/real_field.h.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "hil/acquire/acquire_plan.h"
#include "protocols/telemetry.h"

namespace omnihil {

struct WatchedBy {
  bool hears = false;  // the robot's answers
  bool sees = false;   // vision
};

// Who may stop a run, by what it says: empty, or why not.
class DriveWatch {
 public:
  virtual ~DriveWatch() = default;
  virtual void begin(std::int64_t now_ns) = 0;
  virtual std::string broken(std::int64_t now_ns) const = 0;
  virtual std::string not_ready(std::int64_t now_ns) const = 0;
};

class LimitWatch final : public DriveWatch {
 public:
  static constexpr double kLasting_s = 0.2;  // a start of a robot takes that long: a choice

  LimitWatch(const PlanLimits& limits, WatchedBy by) : limits_(limits), by_(by) {}

  void heard(std::int64_t now_ns) { heard_ns_ = now_ns; }
  void told(std::int64_t now_ns, const TelemetryReading& reading);
  void seen(std::int64_t now_ns, const std::array<double, 3>& pose);
  void begin(std::int64_t now_ns) override;

  // Empty, or which limit and by how much.
  std::string broken(std::int64_t now_ns) const override;
  // Heard and seen of late, and at rest: a run may begin. Empty, or what is missing.
  std::string not_ready(std::int64_t now_ns) const override;

  const std::optional<std::array<double, 3>>& pose() const { return pose_; }
  double speed_m_s() const;

 private:
  std::string silent(std::int64_t now_ns) const;
  bool late(const std::optional<std::int64_t>& then_ns, std::int64_t now_ns) const;

  PlanLimits limits_;
  WatchedBy by_;
  std::optional<std::int64_t> heard_ns_, seen_ns_, low_since_ns_, moved_ns_;
  std::optional<std::array<double, 3>> pose_;
  std::array<double, 2> velocity_m_s_{};
  std::optional<std::array<double, 2>> start_m_;
  double battery_V_ = 0.0, current_A_ = 0.0;
};

}  // namespace omnihil
