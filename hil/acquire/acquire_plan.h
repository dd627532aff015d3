// What a robot is to be asked, run by run: a plan that `experiment` writes, people edit and `acquire` carries out.
//
//   PlanReading read = read_acquire_plan(text, "plan.toml");
//   if (!read.plan) for (const ModelProblem& p : read.problems) std::cerr << p.text() << "\n";
//   plan_value(read.plan->runs[0], 1.25);          // asked at 1.25 s: held from a step to the next
//   plan_text(*read.plan);                         // the file again
//
// The file, "omnihil-plan/1":
//   drive = "body_velocity"        steps of [s, m/s forward, m/s left, rad/s]
//         = "wheel_speed"          steps of [s, rad/s of wheel 1, 2, 3, 4]
//         = "wheel_duty"           steps of [s, duty of wheel 1, 2, 3, 4]
//         = "motor_voltage", "motor_torque", "duty"     of one axis on a bench: steps of [s, V], [s, N m], [s, 1]
//   packets_Hz, rest_s             packets a second; zero is asked for that long behind each run
//   [limits]                       of drive_limits.h
//   [[run]] name, use, excitation, duration_s, steps
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware_iface/robot_io.h"
#include "identify/record/dataset.h"
#include "sim/model/model_file.h"

namespace omnihil {

enum class PlanDrive : std::uint8_t {
  kBodyVelocity,
  kWheelSpeed,
  kWheelDuty,
  kMotorVoltage,  // from here on: of one axis
  kMotorTorque,
  kDuty
};
std::string_view plan_drive_word(PlanDrive drive);
constexpr bool of_axis(PlanDrive drive) { return drive >= PlanDrive::kMotorVoltage; }
int plan_drive_size(PlanDrive drive);            // numbers of a step beside its time
std::uint32_t plan_drive_mode(PlanDrive drive);  // OMNIHIL_MODE_*, of a robot

struct PlanStep {
  double at_s = 0.0;
  std::array<double, kWheels> value{};
};

struct PlanRun {
  std::string name;
  Split use = Split::kTraining;
  std::string excitation;
  double duration_s = 0.0;
  std::vector<PlanStep> steps;  // the first at 0, rising
};

// 0, or none: not watched.
struct PlanLimits {
  std::optional<std::array<double, 4>> area_m;  // x from, y from, x to, y to: in the field, as vision has it
  double travel_m = 0.0;                        // from where a run began
  double speed_m_s = 0.0;
  double speed_rad_s = 0.0;  // of an axis, at its output
  double travel_rad = 0.0;   // of an axis, from where a run began
  double battery_V = 0.0;    // at least
  double current_A = 0.0;    // of a motor
  double silence_s = 0.5;    // of the robot, or of vision
};

struct AcquirePlan {
  std::string title;
  PlanDrive drive = PlanDrive::kBodyVelocity;
  double packets_Hz = 60.0;
  double rest_s = 0.5;
  PlanLimits limits;
  std::vector<PlanRun> runs;
};

struct PlanReading {
  std::optional<AcquirePlan> plan;  // only without problems
  std::vector<ModelProblem> problems;
};

PlanReading read_acquire_plan(std::string_view text, const std::string& shown_name);
std::string plan_text(const AcquirePlan& plan);

// Zero before 0 and from duration_s on.
std::array<double, kWheels> plan_value(const PlanRun& run, double time_s);
RobotCommand plan_command(PlanDrive drive, const std::array<double, kWheels>& value);

}  // namespace omnihil
