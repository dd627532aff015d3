// What passed in one run, on our clock, and its rows as a measurement has them.
//
//   RunLog log;                                                 // filled by acquire_loop.h
//   RunRows rows = run_rows(log, PlanDrive::kBodyVelocity);
//   std::string csv = rows_csv(rows);
//
// A row per command, per answer and per camera frame, from kLead_s before the first packet that drives to the last stop
// packet. Commands of formats that ask in the field's frame stand as what the robot makes of them: turned back by the heading
// that it tells (else the camera's) at each row's time. A frame's time is its capture, brought to our clock by its camera's
// line (clock_line.h).
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hil/acquire/acquire_plan.h"
#include "hil/loop/clock_line.h"
#include "protocols/telemetry.h"

namespace omnihil {

struct SentCommand {
  std::int64_t now_ns = 0;
  std::array<double, kWheels> value{};  // in_field: as sent, in the field's frame
  bool in_field = false;
};
struct HeardTelemetry {
  std::int64_t now_ns = 0;
  TelemetryReading told;
};
struct SeenFrame {
  unsigned camera = 0;
  double capture_s = 0.0;  // of its clock
  double x_m = 0.0, y_m = 0.0, yaw_rad = 0.0;
};

struct RunLog {
  std::int64_t driving_from_ns = 0, end_ns = 0;
  std::vector<SentCommand> sent;
  std::vector<HeardTelemetry> told;
  std::vector<SeenFrame> seen;
  std::map<unsigned, ClockLine> cameras;
};

// NaN: an empty cell. Columns that hold nothing are left out.
struct RunRows {
  std::vector<std::string> columns;         // beside time_s
  std::vector<double> time_s;               // from the first row's time on
  double start_s = 0.0;                     // that time, on the log's clock
  std::vector<std::vector<double>> values;  // [column][row]

  const std::vector<double>* column(const std::string& name) const;
};

inline constexpr double kLead_s = 0.2;  // the robot stands: what telemetry shows of that is worth a few rows

RunRows run_rows(const RunLog& log, PlanDrive drive);
// The same of any stretch of the log's clock, both ends included.
RunRows rows_between(const RunLog& log, PlanDrive drive, double from_s, double to_s);
std::string rows_csv(const RunRows& rows);

// The columns of a plan's drive: "cmd_vx" …, "wheel_cmd_1" …, "duty_1" …
std::vector<std::string> drive_columns(PlanDrive drive);

}  // namespace omnihil
