#include "protocols/telemetry.h"

#include <cmath>
#include <numbers>

#include "protocols/codec.h"
#include "protocols/meaning.h"

namespace omnihil {
namespace {

using Member = double& (*)(TelemetryReading&);
template <std::size_t w>
constexpr Member kWheel = [](TelemetryReading& t) -> double& { return t.omega_wheel_rad_s[w]; };
template <std::size_t w>
constexpr Member kCurrent = [](TelemetryReading& t) -> double& { return t.motor_current_A[w]; };
constexpr Member kBattery = [](TelemetryReading& t) -> double& { return t.battery_V; };
constexpr Member kYaw = [](TelemetryReading& t) -> double& { return t.yaw_rad; };
constexpr Member kTurnRate = [](TelemetryReading& t) -> double& { return t.omega_body_rad_s; };

constexpr double kRadPerTurn = 2.0 * std::numbers::pi;
constexpr double kRadPerDegree = std::numbers::pi / 180.0;
constexpr double kErforceFull_V = 25.2;  // docs/dongles.md: the battery is a share of it

// quantity = times * number + offset. Sources: the formats' own files.
struct Row {
  std::string_view message, field;
  Member member;
  double times = 1.0, offset = 0.0;
};
constexpr Row kRows[] = {
    {"REM_RobotStateInfo", "wheelSpeed1", kWheel<0>},
    {"REM_RobotStateInfo", "wheelSpeed2", kWheel<1>},
    {"REM_RobotStateInfo", "wheelSpeed3", kWheel<2>},
    {"REM_RobotStateInfo", "wheelSpeed4", kWheel<3>},
    {"REM_RobotStateInfo", "xsensYaw", kYaw},
    {"REM_RobotStateInfo", "rateOfTurn", kTurnRate},
    {"REM_RobotFeedback", "yaw", kYaw},
    {"REM_RobotFeedback", "angle", kYaw},
    {"REM_RobotFeedback", "batteryLevel", kBattery},
    {"BATTERIE_RESPONSE", "decivolts", kBattery, 0.1, 0.05},  // cut off, not rounded
    {"FEEDBACK", "tx_value_array[6]", kWheel<0>, kRadPerTurn},
    {"FEEDBACK", "tx_value_array[7]", kWheel<1>, kRadPerTurn},
    {"FEEDBACK", "tx_value_array[8]", kWheel<2>, kRadPerTurn},
    {"FEEDBACK", "tx_value_array[9]", kWheel<3>, kRadPerTurn},
    {"FEEDBACK", "tx_value_array[12]", kTurnRate},
    {"FEEDBACK", "imu_yaw_deg", kYaw, kRadPerDegree},
    {"FEEDBACK", "battery_voltage_bldc_right", kBattery},
    {"telemetry", "battery", kBattery},
    {"match_feedback", "batteryLevel", kBattery, 0.1, 0.05},
    {"match_feedback", "curPosition[2]", kYaw, 0.001},
    {"match_feedback", "curVelocity[2]", kTurnRate, 0.001},
    {"status", "voltage_raw", kBattery, 0.125, 0.0625},
    {"status", "ang_raw", kYaw, 0.001},
    {"response", "battery", kBattery, kErforceFull_V},
    {"BaseFeedback", "motor_1_speed", kWheel<0>},
    {"BaseFeedback", "motor_2_speed", kWheel<1>},
    {"BaseFeedback", "motor_3_speed", kWheel<2>},
    {"BaseFeedback", "motor_4_speed", kWheel<3>},
    {"BaseFeedback", "voltage", kBattery},
    {"robot_status_message", "battery_voltage", kBattery, 0.09884, 0.04942},  // cut off
};
// By what their fields mean.
struct MeansRow {
  std::string_view word;
  Member member;
};
constexpr MeansRow kMeans[] = {
    {"omega_wheel_rad_s[0]", kWheel<0>},
    {"omega_wheel_rad_s[1]", kWheel<1>},
    {"omega_wheel_rad_s[2]", kWheel<2>},
    {"omega_wheel_rad_s[3]", kWheel<3>},
    {"omega_body_rad_s", kTurnRate},
    {"yaw_rad", kYaw},
    {"battery_V", kBattery},
};

// REM v5's four bits hold whole volts above 15 (docs/dongles.md).
constexpr double kRemV5Base_V = 15.0;
constexpr int kRemV5Bits = 4;

bool from_robot(const Message& m) {
  return m.direction == Direction::kFromRobot || m.direction == Direction::kBoth;
}

// Calls use(field, member, times, offset) for every field that tells something.
template <typename Use>
void each_told(const Message& message, const Use& use) {
  if (!from_robot(message)) return;
  for (std::size_t i = 0; i < message.fields.size(); ++i) {
    const Field& field = message.fields[i];
    for (const Row& row : kRows) {
      if (row.message != message.name || row.field != field.name) continue;
      const bool v5 = row.field == "batteryLevel" && field.bits == kRemV5Bits;
      use(i, row.member, row.times, v5 ? kRemV5Base_V : row.offset);
    }
    if (field.means == nullptr || message.role != MessageRole::kFeedback) continue;
    for (const MeansRow& row : kMeans) {
      if (row.word == field.means->word) use(i, row.member, field.times, 0.0);
    }
  }
}

}  // namespace

std::optional<TelemetryReading> telemetry_of(const RadioFormat&, const Values& values) {
  TelemetryReading reading;
  bool any = false;
  each_told(*values.message, [&](std::size_t field, Member member, double times, double offset) {
    const double number = values.fields[field].number;
    if (!std::isfinite(number)) return;
    member(reading) = times * number + offset;
    any = true;
  });
  if (!any) return std::nullopt;
  // REM's role of a robot is the receiver's: the sender goes first.
  double robot = values.number_or("fromRobotId", -1.0);
  if (robot < 0.0) robot = values.number_or(FieldRole::kRobot, -1.0);
  for (const std::string_view name : {"robot", "bot", "number"}) {
    if (robot < 0.0) robot = values.number_or(name, -1.0);
  }
  reading.robot_id = static_cast<int>(robot);
  return reading;
}

bool tells_anything(const RadioFormat& format) {
  bool any = false;
  for (const Message& m : format.messages)
    each_told(m, [&](std::size_t, Member, double, double) { any = true; });
  return any;
}

namespace {

const Field* wheel_field(const RadioFormat& format, double& times) {
  const Field* found = nullptr;
  for (const Message& m : format.messages) {
    each_told(m, [&](std::size_t i, Member member, double by, double) {
      TelemetryReading probe;
      if (&member(probe) != &probe.omega_wheel_rad_s[0]) return;
      found = &m.fields[i];
      times = by;
    });
  }
  return found;
}

}  // namespace

bool tells_wheel_speeds(const RadioFormat& format) {
  double times = 1.0;
  return wheel_field(format, times) != nullptr;
}

double wheel_speed_step_rad_s(const RadioFormat& format) {
  double times = 1.0;
  const Field* field = wheel_field(format, times);
  return field == nullptr ? 0.0 : std::abs(times) * field_step(*field);
}

}  // namespace omnihil
