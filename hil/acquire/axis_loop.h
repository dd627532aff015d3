// Runs of a plan on one axis, on the wall clock: demands out, samples in, the stop whatever happens.
//
//   AxisAcquirer acquirer(end, plan);
//   AxisRunEnd done = acquirer.run(plan.runs[0], [] { return StopSignals::requested(); });
//   done.problem;                                     // empty: it ran to its end
//   rows_csv(axis_rows(done.samples, plan.drive));
//
// The same order of things as with a robot (run_driver.h). A sample whose answer came so late that its time is uncertain by half
// a period is left as its demand alone. A run ends with its last demand: what follows is an axis that is
// let go, of which the model would have to know more than its motor.
#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "hil/acquire/axis_end.h"
#include "hil/acquire/run_driver.h"
#include "hil/acquire/run_log.h"

namespace omnihil {

struct AxisRunEnd {
  std::vector<AxisMoment> samples;  // from kLead_s before the first demand to the last
  std::string problem;              // why it was stopped; empty: at its end
  bool wire_lost = false;
  std::string packets;
  int asked = 0, left_out = 0;  // demands; those that were too late
  double latest_s = 0.0;        // the most that one was written after its time
};

class AxisAcquirer {
 public:
  AxisAcquirer(AxisEnd& end, const AcquirePlan& plan) : end_(end), plan_(plan) {}
  AxisRunEnd run(const PlanRun& run, const std::function<bool()>& stop);

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t now_ns() const {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start_).count();
  }
  void wait_until(std::int64_t until_ns) const;

  AxisEnd& end_;
  const AcquirePlan& plan_;
  Clock::time_point start_ = Clock::now();
};

// Columns: the drive's word, then encoder, or position and velocity, current, bus; what no sample tells is left out. Duty and voltage
// are held from a row on; a torque is that of the row's instant, as a signal that was measured: at a step the mean of both sides.
RunRows axis_rows(const std::vector<AxisMoment>& samples, PlanDrive drive);

}  // namespace omnihil
