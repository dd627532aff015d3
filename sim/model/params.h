// A number of a model: value, unit, bounds, how well it is known and whence. One row per parameter says what
// it is; reader, messages, explanations, documentation and fits all go by that row.
//
//   const ParameterTable& table = model.parameters;
//   const Parameter* r = table.find("motor.resistance_ohm");
//   r->value();        // 1.2
//   r->tolerance;      // 0.1: relative 1-sigma; absent: known exactly
//   r->row->unit;      // "ohm"
//
// SI, except where the file format itself says otherwise in the key (wheel_angle_deg, no_load_speed_rpm).
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/law/fitted_number.h"
#include "sim/law/spelling.h"
#include "sim/robot/robot_model.h"

namespace omnihil {

// Which model files a row belongs to; a set of bits.
enum RigBit : std::uint32_t {
  kRigRobot = 1u << 0,
  kRigAxis = 1u << 1,        // one rotary drive
  kRigLinearAxis = 1u << 2,  // one linear drive
  kRigMotor = 1u << 3,       // a motor's own file
};

// What a value looks like in the file.
enum class ParameterKind : std::uint8_t {
  kNumber,
  kWholeNumber,
  kWheelNumbers,  // one number per wheel
  kText,
  kTruth,   // true or false; kept as 1 or 0
  kChoice,  // one word of a list; kept as its place in the list, and as text
};

using ParameterStore = void (*)(RobotModel&, std::span<const double>);

struct ParameterRow {
  std::string_view section;  // "motor"; "" is the top of the file
  std::string_view key;      // "resistance_ohm": the unit is its suffix
  ParameterKind kind = ParameterKind::kNumber;
  std::string_view unit;            // "ohm"; "1": a ratio
  std::optional<double> otherwise;  // value when the file does not give one
  double lower = 0.0;
  double upper = 0.0;
  bool above_lower = false;                     // the lower bound itself is not allowed
  std::uint32_t rigs = 0;                       // RigBit
  std::uint32_t needed = 0;                     // RigBit: a file of this rig must give it
  std::string_view what;                        // one line
  std::string_view how;                         // how to measure it
  ParameterStore store = nullptr;               // into a RobotModel; null: kept in the table alone
  std::span<const std::string_view> choices{};  // kChoice
};

enum class Origin : std::uint8_t { kDefault, kMotorFile, kRobotFile, kSet };

struct Parameter {
  const ParameterRow* row = nullptr;
  std::vector<double> values{};       // one, or one per wheel; empty for text
  std::string text{};                 // kText, kChoice
  std::optional<double> tolerance{};  // of the belief: relative 1-sigma; absent: known exactly
  std::string source{};               // of the belief
  std::optional<FittedNumber> fitted{};
  Origin origin = Origin::kDefault;
  int line = 0;  // in the file of its origin; 0: not from a file
  int column = 0;

  double value() const { return values.empty() ? 0.0 : values.front(); }
  double believed() const { return fitted && fitted->believed ? *fitted->believed : value(); }
};

// "motor.resistance_ohm"; the key alone at the top of the file.
std::string parameter_path(const ParameterRow& row);

inline bool is_text(const ParameterRow& row) {
  return row.kind == ParameterKind::kText || row.kind == ParameterKind::kChoice;
}

// "more than 0 up to 1000 ohm", "-360 to 360 deg", "0 or more, whole"
std::string allowed_range(const ParameterRow& row);

bool within_bounds(const ParameterRow& row, double value);

struct ParameterTable {
  std::vector<Parameter> parameters;  // in the order of the rows

  const Parameter* find(std::string_view path) const;
  Parameter* find(std::string_view path);
  // Value of `path`, or `otherwise` when the table does not have it.
  double value_or(std::string_view path, double otherwise) const;
  // Sets one number; "" or what is wrong with it. All entries of a wheel list get the same value.
  std::string set(std::string_view path, double value);
};

// The numbers of the table in their places. Text and what the table lacks are left at the struct's defaults.
RobotModel robot_model_of(const ParameterTable& table);

}  // namespace omnihil
