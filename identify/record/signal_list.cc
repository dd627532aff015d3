#include "identify/record/signal_list.h"

namespace omnihil {
namespace {

using enum SignalRole;

// A row per wheel that a robot may have (kMaxWheels).
#define EACH_WHEEL(name, ...)                                                                             \
  {name "_1", __VA_ARGS__}, {name "_2", __VA_ARGS__}, {name "_3", __VA_ARGS__}, {name "_4", __VA_ARGS__}, \
      {name "_5", __VA_ARGS__}, {                                                                         \
    name "_6", __VA_ARGS__                                                                                \
  }

constexpr SignalRow kRows[] = {
    {"time", "s", "s", kTime, Rig::kAxis, ""},
    {"duty", "1", "1", kDrive, Rig::kAxis, "duty"},
    {"motor_voltage", "V", "V", kDrive, Rig::kAxis, "motor_voltage"},
    {"motor_torque", "N m", "N", kDrive, Rig::kAxis, "motor_torque"},
    {"position_target", "rad", "", kDrive, Rig::kAxis, "position_target"},
    {"enable", "1", "1", kFlag, Rig::kAxis, ""},
    {"bus_voltage", "V", "V", kMeasured, Rig::kAxis, ""},
    {"motor_current", "A", "A", kMeasured, Rig::kAxis, ""},
    {"encoder", "counts", "counts", kCounts, Rig::kAxis, ""},
    {"position", "rad", "m", kMotion, Rig::kAxis, ""},
    {"velocity", "rad/s", "m/s", kMotion, Rig::kAxis, ""},
    {"winding_temperature", "degC", "degC", kMeasured, Rig::kAxis, ""},
    {"load_torque", "N m", "N", kMeasured, Rig::kAxis, ""},

    {"time", "s", "", kTime, Rig::kRobot, ""},
    EACH_WHEEL("duty", "1", "", kDrive, Rig::kRobot, "duty"),
    {"command_vx", "m/s", "", kDrive, Rig::kRobot, "command"},
    {"command_vy", "m/s", "", kDrive, Rig::kRobot, "command"},
    {"command_w", "rad/s", "", kDrive, Rig::kRobot, "command"},
    EACH_WHEEL("command_wheel", "rad/s", "", kDrive, Rig::kRobot, "command_wheel"),
    {"dribbler", "rad/s", "", kMeasured, Rig::kRobot, ""},
    EACH_WHEEL("encoder", "counts", "", kCounts, Rig::kRobot, ""),
    EACH_WHEEL("wheel_speed", "rad/s", "", kMotion, Rig::kRobot, ""),
    EACH_WHEEL("motor_current", "A", "", kMeasured, Rig::kRobot, ""),
    {"bus_voltage", "V", "", kMeasured, Rig::kRobot, ""},
    {"gyro_z", "rad/s", "", kMotion, Rig::kRobot, ""},
    {"accel_x", "m/s^2", "", kMeasured, Rig::kRobot, ""},
    {"accel_y", "m/s^2", "", kMeasured, Rig::kRobot, ""},
    {"vision_x", "m", "", kMotion, Rig::kRobot, ""},
    {"vision_y", "m", "", kMotion, Rig::kRobot, ""},
    {"vision_theta", "rad", "", kMotion, Rig::kRobot, ""},
    {"body_vx", "m/s", "", kMotion, Rig::kRobot, ""},
    {"body_vy", "m/s", "", kMotion, Rig::kRobot, ""},
    {"body_w", "rad/s", "", kMotion, Rig::kRobot, ""},
    {"force_x", "N", "", kMeasured, Rig::kRobot, ""},
    {"force_y", "N", "", kMeasured, Rig::kRobot, ""},

    {"time", "s", "", kTime, Rig::kWheel, ""},
    {"duty", "1", "", kDrive, Rig::kWheel, "duty"},
    {"enable", "1", "", kFlag, Rig::kWheel, ""},
    {"body_vx", "m/s", "", kMotion, Rig::kWheel, ""},
    {"body_vy", "m/s", "", kMotion, Rig::kWheel, ""},
    {"bus_voltage", "V", "", kMeasured, Rig::kWheel, ""},
    {"motor_current", "A", "", kMeasured, Rig::kWheel, ""},
    {"encoder", "counts", "", kCounts, Rig::kWheel, ""},
    {"wheel_speed", "rad/s", "", kMotion, Rig::kWheel, ""},
    {"force_x", "N", "", kMeasured, Rig::kWheel, ""},
    {"force_y", "N", "", kMeasured, Rig::kWheel, ""},
};
#undef EACH_WHEEL

}  // namespace

std::span<const SignalRow> signal_rows() { return kRows; }

const SignalRow* find_signal(Rig rig, std::string_view name) {
  for (const SignalRow& row : kRows) {
    if (row.rig == rig && row.name == name) return &row;
  }
  return nullptr;
}

std::string_view signal_unit(const SignalRow& row, bool linear) {
  return linear ? row.linear_unit : row.unit;
}

std::vector<std::string_view> signal_names(Rig rig) {
  std::vector<std::string_view> names;
  for (const SignalRow& row : kRows) {
    if (row.rig == rig) names.push_back(row.name);
  }
  return names;
}

std::vector<std::string_view> drive_group_signals(Rig rig, std::string_view group) {
  std::vector<std::string_view> names;
  for (const SignalRow& row : kRows) {
    if (row.rig == rig && row.role == SignalRole::kDrive && row.drive_group == group)
      names.push_back(row.name);
  }
  return names;
}

}  // namespace omnihil
