// The signals that a measurement may have (format "omnihil-dataset/1"): one row each, with unit and role. A rig has a list
// of its own (rig.h).
//
//   const SignalRow* row = find_signal(rig, "velocity");        // null: this rig has none
//   signal_unit(*row, linear);                                  // "rad/s"; on a linear axis "m/s"
//
// A run is driven by one group of drive signals: "duty" alone, or "duty_1", "duty_2" … together, one per wheel.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "identify/record/dataset.h"

namespace omnihil {

enum class SignalRole : std::uint8_t {
  kTime,
  kDrive,     // what was asked of the drive
  kMotion,    // position, speed, pose: outputs that the model has to explain
  kCounts,    // position as cumulative encoder counts
  kFlag,      // 0 or 1
  kMeasured,  // any other sensor: current, voltage, temperature, acceleration
};

// Is it set by the bench, and taken as given?
enum class Imposed : std::uint8_t { kNever, kWhereSaid, kAlways };

struct SignalRow {
  std::string_view name;
  std::string_view unit;
  std::string_view linear_unit;  // "": the signal has no meaning on a linear axis
  SignalRole role;
  std::string_view drive_group = "";  // of a drive signal
  Imposed imposed = Imposed::kNever;
};

const SignalRow* find_signal(const Rig& rig, std::string_view name);
std::string_view signal_unit(const SignalRow& row, bool linear);

// Names of a rig's signals, for messages.
std::vector<std::string_view> signal_names(const Rig& rig);

// Signals of one drive group: {"command_vx", "command_vy", "command_w"}.
std::vector<std::string_view> drive_group_signals(const Rig& rig, std::string_view group);

}  // namespace omnihil
