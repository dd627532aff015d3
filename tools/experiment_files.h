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
// motion as extrapolation (body_drive.h; of duties, wheel speeds and an axis the run at half its level, in reverse order of time).
// None of a linear axis, a servo, a bench that imposes the speed. `gear_ratio`: of an axis, whose plan has its output's speed.
std::optional<AcquirePlan> acquire_plan_of(const ExperimentPlan& plan, const ExperimentLimits& limits,
                                           double packets_Hz, const BodyDriveOptions& other,
                                           double gear_ratio = 1.0);

// Drives for a first measurement, with nothing known yet: random to fit and to hold out, a scan as extrapolation.
AcquirePlan usual_plan(const BodyDriveOptions& drive, double packets_Hz);

// The same of one axis: steps, a slow ramp through zero and a sine of rising frequency, a third each, to fit; the same at 0.8 of
// it with other steps to hold out; reversals as extrapolation. `level`: the most that is asked, V, N m or duty.
AcquirePlan usual_axis_plan(PlanDrive drive, double level, const ExperimentLimits& limits, double packets_Hz,
                            std::uint64_t seed);

// The plan for a reader: what, how far it separates, what the run does, what was refused.
std::string plan_text(const ExperimentPlan& plan);

}  // namespace omnihil
