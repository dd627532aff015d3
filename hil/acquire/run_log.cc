#include "hil/acquire/run_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace omnihil {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kTurn = 2.0 * std::numbers::pi;

// A heading over time, unwrapped; on straight lines between its samples, constant outside.
class Heading {
 public:
  void add(double time_s, double yaw_rad) {
    if (!std::isfinite(yaw_rad) || (!time_s_.empty() && time_s <= time_s_.back())) return;
    const double last = yaw_.empty() ? yaw_rad : yaw_.back();
    time_s_.push_back(time_s);
    yaw_.push_back(last + std::remainder(yaw_rad - last, kTurn));
  }
  bool known() const { return !yaw_.empty(); }
  double at(double time_s) const {
    const auto after = std::upper_bound(time_s_.begin(), time_s_.end(), time_s) - time_s_.begin();
    if (after == 0) return yaw_.front();
    if (after == static_cast<std::ptrdiff_t>(yaw_.size())) return yaw_.back();
    const auto k = static_cast<std::size_t>(after);
    return yaw_[k - 1] + (yaw_[k] - yaw_[k - 1]) * (time_s - time_s_[k - 1]) / (time_s_[k] - time_s_[k - 1]);
  }

 private:
  std::vector<double> time_s_, yaw_;
};

struct Row {
  double time_s = 0.0;
  std::array<double, kWheels> command{kNaN, kNaN, kNaN, kNaN};
  TelemetryReading told;
  std::array<double, 3> vision{kNaN, kNaN, kNaN};
};

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

std::vector<Row> sorted_rows(const RunLog& log) {
  std::vector<Row> rows;
  for (const HeardTelemetry& h : log.told) {
    Row& row = rows.emplace_back();
    row.time_s = seconds(h.now_ns);
    row.told = h.told;
  }
  std::map<unsigned, ClockFit> clocks;
  for (const auto& [camera, line] : log.cameras) clocks[camera] = line.fit();
  for (const SeenFrame& f : log.seen) {
    const auto clock = clocks.find(f.camera);
    if (clock == clocks.end() || !clock->second.known()) continue;
    Row& row = rows.emplace_back();
    row.time_s = clock->second.ours(f.capture_s);
    row.vision = {f.x_m, f.y_m, f.yaw_rad};
  }
  for (const SentCommand& c : log.sent) {
    Row& row = rows.emplace_back();
    row.time_s = seconds(c.now_ns);
    row.command = c.value;
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.time_s < b.time_s; });
  return rows;
}

// Commands in the field's frame, as the robot turns them into its own.
void turn_back(const RunLog& log, std::vector<Row>& rows) {
  Heading heading;
  for (const Row& row : rows) heading.add(row.time_s, row.told.yaw_rad);
  if (!heading.known()) {
    for (const Row& row : rows) heading.add(row.time_s, row.vision[2]);
  }
  if (!heading.known()) return;
  std::size_t next = 0;
  const SentCommand* last = nullptr;
  for (Row& row : rows) {
    while (next < log.sent.size() && seconds(log.sent[next].now_ns) <= row.time_s) last = &log.sent[next++];
    if (last == nullptr || !last->in_field) continue;
    const double yaw = heading.at(row.time_s), c = std::cos(yaw), s = std::sin(yaw);
    row.command = {c * last->value[0] + s * last->value[1], -s * last->value[0] + c * last->value[1],
                   last->value[2], 0.0};
  }
}

struct Column {
  std::string name;
  double (*get)(const Row&);
};
constexpr std::size_t kTold = 10;
const std::array<Column, kTold + 3>& measured_columns() {
  static const std::array<Column, kTold + 3> all{{
      {"wheel_1", [](const Row& r) { return r.told.omega_wheel_rad_s[0]; }},
      {"wheel_2", [](const Row& r) { return r.told.omega_wheel_rad_s[1]; }},
      {"wheel_3", [](const Row& r) { return r.told.omega_wheel_rad_s[2]; }},
      {"wheel_4", [](const Row& r) { return r.told.omega_wheel_rad_s[3]; }},
      {"current_1", [](const Row& r) { return r.told.motor_current_A[0]; }},
      {"current_2", [](const Row& r) { return r.told.motor_current_A[1]; }},
      {"current_3", [](const Row& r) { return r.told.motor_current_A[2]; }},
      {"current_4", [](const Row& r) { return r.told.motor_current_A[3]; }},
      {"battery", [](const Row& r) { return r.told.battery_V; }},
      {"gyro_z", [](const Row& r) { return r.told.omega_body_rad_s; }},
      {"vision_x", [](const Row& r) { return r.vision[0]; }},
      {"vision_y", [](const Row& r) { return r.vision[1]; }},
      {"vision_theta", [](const Row& r) { return r.vision[2]; }},
  }};
  return all;
}

// Rows at one time, to the microsecond that a file shows, are one.
std::vector<Row> merged(std::vector<Row> rows) {
  std::vector<Row> out;
  const auto take = [](double& into, double from) {
    if (std::isfinite(from)) into = from;
  };
  for (const Row& row : rows) {
    if (out.empty() || row.time_s - out.back().time_s > 1.5e-6) {
      out.push_back(row);
      continue;
    }
    Row& into = out.back();
    for (std::size_t i = 0; i < kWheels; ++i) {
      take(into.command[i], row.command[i]);
      take(into.told.omega_wheel_rad_s[i], row.told.omega_wheel_rad_s[i]);
      take(into.told.motor_current_A[i], row.told.motor_current_A[i]);
    }
    take(into.told.battery_V, row.told.battery_V);
    take(into.told.yaw_rad, row.told.yaw_rad);
    take(into.told.omega_body_rad_s, row.told.omega_body_rad_s);
    for (std::size_t i = 0; i < 3; ++i) take(into.vision[i], row.vision[i]);
  }
  return out;
}

}  // namespace

std::vector<std::string> drive_columns(PlanDrive drive) {
  if (drive == PlanDrive::kBodyVelocity) return {"cmd_vx", "cmd_vy", "cmd_w"};
  if (of_axis(drive)) return {std::string(plan_drive_word(drive))};
  const std::string stem = drive == PlanDrive::kWheelSpeed ? "wheel_cmd_" : "duty_";
  return {stem + "1", stem + "2", stem + "3", stem + "4"};
}

const std::vector<double>* RunRows::column(const std::string& name) const {
  const auto at = std::find(columns.begin(), columns.end(), name);
  return at == columns.end() ? nullptr : &values[static_cast<std::size_t>(at - columns.begin())];
}

RunRows run_rows(const RunLog& log, PlanDrive drive) {
  return rows_between(log, drive, seconds(log.driving_from_ns) - kLead_s, seconds(log.end_ns));
}

RunRows rows_between(const RunLog& log, PlanDrive drive, double from_s, double to_s) {
  std::vector<Row> rows = sorted_rows(log);
  turn_back(log, rows);
  rows = merged(std::move(rows));
  std::erase_if(rows, [&](const Row& r) { return r.time_s < from_s || r.time_s > to_s; });
  RunRows out;
  if (!rows.empty()) out.start_s = rows.front().time_s;
  out.columns = drive_columns(drive);
  for (std::size_t a = 0; a < out.columns.size(); ++a) {
    out.values.emplace_back();
    for (const Row& r : rows) out.values.back().push_back(r.command[a]);
  }
  for (const Row& r : rows) out.time_s.push_back(r.time_s - rows.front().time_s);
  for (const Column& column : measured_columns()) {
    std::vector<double> all;
    for (const Row& r : rows) all.push_back(column.get(r));
    if (std::none_of(all.begin(), all.end(), [](double v) { return std::isfinite(v); })) continue;
    out.columns.push_back(column.name);
    out.values.push_back(std::move(all));
  }
  return out;
}

std::string rows_csv(const RunRows& rows) {
  std::string text = "time_s";
  for (const std::string& column : rows.columns) text += "," + column;
  text += '\n';
  for (std::size_t k = 0; k < rows.time_s.size(); ++k) {
    fmt::format_to(std::back_inserter(text), "{:.6f}", rows.time_s[k]);
    for (const std::vector<double>& column : rows.values) {
      text += ',';
      if (std::isfinite(column[k])) fmt::format_to(std::back_inserter(text), "{:.7g}", column[k]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace omnihil
