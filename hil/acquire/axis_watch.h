// Whether an axis that is driven may be driven on: what it tells, against the plan's limits.
//
//   AxisWatch watch(plan.limits);
//   watch.told(reading);                        // each sample
//   watch.begin(now_ns);                        // a run: travel is counted from here
//   if (const std::string why = watch.broken(now_ns); !why.empty()) stop(why);
//
// Speeds as told; of counts alone by a fading-memory filter. A battery is too low when it stays so for
// LimitWatch::kLasting_s. Cannot: brake; a bridge that lets go leaves the axis to its friction.
#pragma once
#include <optional>

#include "hil/acquire/axis_end.h"
#include "hil/acquire/drive_limits.h"

namespace omnihil {

class AxisWatch final : public DriveWatch {
 public:
  explicit AxisWatch(const PlanLimits& limits) : limits_(limits) {}

  void told(const AxisMoment& reading);
  void trouble(std::string why) { trouble_ = std::move(why); }  // of the device itself; empty: none
  void begin(std::int64_t now_ns) override;
  std::string broken(std::int64_t now_ns) const override;
  std::string not_ready(std::int64_t now_ns) const override;

 private:
  PlanLimits limits_;
  std::string trouble_;
  std::optional<AxisMoment> last_;
  std::optional<std::int64_t> low_since_ns_, moved_ns_;
  std::optional<double> start_rad_;
  double velocity_rad_s_ = 0.0;
};

}  // namespace omnihil
