// A scenario: what is done to one robot with its firmware at which instants, and what must come of it.
//
//   ScenarioReading reading = read_scenario(text, "wheel_step.toml");
//   if (!reading.scenario) for (const ModelProblem& p : reading.problems) std::cerr << p.text();
//
// Text form, a step and a check (scenario_help.h prints all of them):
//   format = "omnihil-scenario/1"
//   title = "Wheel speed step"
//   duration_s = 1.5
//   stand = true                       # the robot on a stand: no wheel touches the floor
//   [[step]]
//   at_s = 0.1
//   do = "command"
//   omega_wheel_rad_s = 20.0           # one for all, or [w0, w1, w2, w3]
//   [[check]]
//   is = "rise_time"
//   at_most_s = 0.30
//
// Instants are whole milliseconds of virtual time. Every number's key ends in its unit.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/firmware_chip.h"
#include "firmware_iface/robot_io.h"
#include "sim/model/model_file.h"
#include "sim/robot/robot_faults.h"

namespace omnihil {

enum class StepKind : std::uint8_t {
  kCommand,
  kDisturb,
  kRadioSilence,
  kBrownOut,
  kEncoderStuck,
  kPhaseLost,
  kWindingHot,
  kWheelLifted,
  kWheelBlocked,
  kBall,
  kRobotAt,
  kOpponentAt,
  kMark,
  kRewind,
  kSet,
  kType,
  kChip,
};

using WheelSet = std::array<bool, kWheels>;

struct ScenarioStep {
  StepKind kind = StepKind::kCommand;
  double at_s = 0.0;
  double until_s = 0.0;  // end of a disturbance or fault; the run's end where none is given
  int line = 0;
  WheelSet wheels{};       // of a fault of wheels
  RobotCommand command{};  // kCommand
  double force_forward_N = 0.0, force_left_N = 0.0, moment_Nm = 0.0;
  double supply_ratio = 1.0;
  double rise_K = 0.0;
  // kCommand: omega_wheel_rad_s holds parts of the top speed, at which the back-EMF meets the largest duty.
  bool of_top_speed = false;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, yaw_rad = 0.0;  // kBall, kRobotAt, kOpponentAt
  double v_x_m_s = 0.0, v_y_m_s = 0.0, v_z_m_s = 0.0;     // kBall
  int opponent = 0;
  std::string variable, value;  // kSet
  std::string typed;            // kType
  ChipFault chip;               // kChip
};

enum class CheckKind : std::uint8_t {
  kRiseTime,
  kOvershoot,
  kSettlingTime,
  kSteadyError,
  kCommandedSign,
  kStopsAfterSilence,
  kStopsSafely,
  kWindUp,
  kCurrentLimit,
  kDutyLimit,
  kControlPeriods,
  kWheelOrder,
  kConsoleSays,
  kConsoleNeverSays,
  kSignal,
};

struct ScenarioCheck {
  CheckKind kind = CheckKind::kSignal;
  int line = 0;
  double from_s = 0.0, to_s = 0.0;
  WheelSet wheels{};
  std::string signal{};                         // of scenario_signals.h
  std::optional<double> at_most{}, at_least{};  // in the check's unit
  double band_ratio = 0.05;                     // kSettlingTime
  double standstill_rad_s = 1.0;                // kStopsAfterSilence, kStopsSafely
  bool magnitude = false;                       // kSignal: of the value's size
  // kConsoleSays, kConsoleNeverSays: this stands in a line; of this port and board alone, where they are given.
  std::string text{}, port{};
  int board = -1;
};

constexpr bool of_console(CheckKind kind) {
  return kind == CheckKind::kConsoleSays || kind == CheckKind::kConsoleNeverSays;
}

enum class CommandPath : std::uint8_t {
  kAny,    // by radio where the firmware decodes one that can say it, else as SI command
  kRadio,  // by radio or not at all
  kHal,    // as SI command
};

struct Scenario {
  std::string file, title, what;
  std::string level =
      "wheel";  // "wheel": means something for a firmware of one wheel, too; "robot"; "field": with a ball
  std::string robot = "omni_default";
  bool stand = false;
  std::string field;  // name of a field with boards and goals; empty: an open floor
  int opponents = 0;  // robots of the other team, without commands
  CommandPath path = CommandPath::kAny;
  double duration_s = 0.0;
  double command_every_s = 0.01;
  std::string text;                 // of the file
  bool goes_on = false;             // after a firmware has failed, too: what do its motors do then?
  std::vector<ScenarioStep> steps;  // by time
  std::vector<ScenarioCheck> checks;
};

struct ScenarioReading {
  std::optional<Scenario> scenario;  // only without problems
  std::vector<ModelProblem> problems;
};

ScenarioReading read_scenario(std::string_view text, const std::string& file);

// What a fault's step puts in force (a disturbance is one, radio silence is none of the robot's).
RobotFaults faults_of(const ScenarioStep& step);

// A step that lasts, as the inside of its table: `at_s = 1.0, for_s = 0.2, do = "wheel_blocked", wheels = [0]`. until_s is
// infinite where for_s is not given. What is wrong goes to `problems`, a line each.
std::optional<ScenarioStep> read_fault(std::string_view text, std::vector<std::string>& problems);

}  // namespace omnihil
