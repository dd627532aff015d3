// What `omnihil experiment` writes: the planned run as a table, as radio packets, and in words.
//
//   folder.write("run.csv", planned_csv(run));
//   std::string fault;
//   folder.write("stream.txt", planned_stream(run, format, {.robot_id = 3}, 100.0, fault));
#pragma once
#include <optional>
#include <string>

#include "hil/acquire/acquire_plan.h"
#include "identify/design/body_drive.h"
#include "identify/design/experiment.h"
#include "protocols/radio_format.h"

namespace omnihil {

// time_s and what is asked, as `omnihil sim MODEL --excite run.csv` takes it back.
std::string planned_csv(const PlannedRun& run);

// The four duties as frames, `rate_Hz` a second, and zero at the end: as `omnihil play` takes it. `fault`:
// why there is none.
std::string planned_stream(const PlannedRun& run, const RadioFormat& format, CommandTo robot, double rate_Hz,
                           std::string& fault);

// The runs of a plan for `omnihil acquire`: the proposed run to fit, the same with its signs reversed to hold out, and another kind of
// motion as extrapolation (body_drive.h; of duties and wheel speeds the run at half its level, in reverse order of time). None of
// an axis.
std::optional<AcquirePlan> acquire_plan_of(const ExperimentPlan& plan, const ExperimentLimits& limits,
                                           double packets_Hz, const BodyDriveOptions& other);

// Drives for a first measurement, with nothing known yet: random to fit and to hold out, a scan as extrapolation.
AcquirePlan usual_plan(const BodyDriveOptions& drive, double packets_Hz);

// The plan for a reader: what, how far it separates, what the run does, what was refused.
std::string plan_text(const ExperimentPlan& plan);

}  // namespace omnihil
