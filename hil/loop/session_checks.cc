#include "hil/loop/session_checks.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "protocols/radio_format.h"
#include "sim/model/params.h"
#include "sim/robot/electric_model.h"

namespace omnihil {
namespace {

constexpr int kMaxRobotId = 15;  // four bits in every radio format served

// The first value that is not finite, as "name" or "name[i]".
class FiniteScan {
 public:
  void check(std::string_view name, double value) {
    if (found_.empty() && !std::isfinite(value)) found_ = name;
  }
  template <class Values>
  void check(std::string_view name, const Values& values) {
    if (!found_.empty()) return;
    int index = 0;
    for (const double value : values) {
      if (!std::isfinite(value)) {
        found_ = fmt::format("{}[{}]", name, index);
        return;
      }
      ++index;
    }
  }
  std::string take() { return std::move(found_); }

 private:
  std::string found_;
};

void id_problems(const char* who, std::size_t models, const std::vector<int>& ids,
                 std::vector<std::string>& problems) {
  if (models != ids.size()) {
    problems.push_back(
        fmt::format("{}: {} models for {} robot ids; there must be one for each", who, models, ids.size()));
  }
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] < 0 || ids[i] > kMaxRobotId)
      problems.push_back(fmt::format("{}: id {}: allowed are 0 to {}", who, ids[i], kMaxRobotId));
    if (i > 0 && ids[i] <= ids[i - 1])
      problems.push_back(
          fmt::format("{}: id {} after {}: ids must ascend, each once", who, ids[i], ids[i - 1]));
  }
}

void radio_problems(const std::string& radio, std::size_t robots, std::vector<std::string>& problems) {
  const RadioFormat* format = find_radio_format(radio);
  if (format != nullptr && !format->names_robots() && robots > 1) {
    problems.push_back(fmt::format(
        "robots: packets of radio {} name no robot: one wire, one robot; start a bench for each", radio));
  }
  if (format != nullptr && !format->has_dongle()) {
    problems.push_back(fmt::format(
        "radio: {} is spoken between boards of a robot, by no radio; see serve --motor-bus", radio));
  }
  if (format != nullptr) return;
  std::vector<std::string_view> known;
  for (const RadioFormat* each : radio_formats()) known.push_back(each->id);
  const std::string_view nearest = nearest_spelling(radio, known);
  problems.push_back(fmt::format("radio: unknown format \"{}\"{}; known: {}", radio,
                                 nearest.empty() ? "" : fmt::format(", did you mean {}?", nearest),
                                 fmt::join(known, ", ")));
}

}  // namespace

std::vector<std::string> radio_format_ids() {
  std::vector<std::string> ids;
  for (const RadioFormat* format : radio_formats()) ids.emplace_back(format->id);
  return ids;
}

namespace {

// Radio formats, firmware and recordings have tables of four.
void wheel_problems(const char* who, const std::vector<RobotModel>& robots,
                    std::vector<std::string>& problems) {
  for (const RobotModel& m : robots) {
    if (m.wheels == kWheels) continue;
    problems.push_back(
        fmt::format("{}: \"{}\" has {} wheels; radio, firmware and recordings know four. Without them it "
                    "drives by sim, fit and "
                    "diagnose",
                    who, m.name, m.wheels));
  }
}

}  // namespace

std::vector<std::string> session_problems(const SessionConfig& config) {
  std::vector<std::string> problems = air_problems(config.air);
  radio_problems(config.radio_format, config.robot_ids.size(), problems);
  if (!config.opponents.radio_format.empty())
    radio_problems(config.opponents.radio_format, config.opponents.robot_ids.size(), problems);
  if (config.robot_ids.empty()) problems.push_back("robots: none; a session needs at least one");
  id_problems("robots", config.robots.size(), config.robot_ids, problems);
  id_problems("opponents", config.opponents.robots.size(), config.opponents.robot_ids, problems);
  wheel_problems("robots", config.robots, problems);
  wheel_problems("opponents", config.opponents.robots, problems);
  std::vector<int> keys = config.robot_ids;
  for (const int id : config.opponents.robot_ids) keys.push_back(kOpponentKey + id);
  for (std::string& problem : fault_problems(config.faults, keys)) problems.push_back(std::move(problem));
  const std::int64_t mechanical_ns = config.plant.mechanical_step_ns;
  if (mechanical_ns <= 0) {
    problems.push_back(fmt::format("mechanical step: {} ns; must be more than 0", mechanical_ns));
  } else if (config.step_ns <= 0 || config.step_ns % mechanical_ns != 0) {
    problems.push_back(fmt::format("step: {} ns; must be a multiple of the mechanical step, {} ns",
                                   config.step_ns, mechanical_ns));
  }
  return problems;
}

std::vector<std::string> firmware_problems(const SessionConfig& config,
                                           std::span<const std::unique_ptr<Firmware>> firmware) {
  std::vector<std::string> problems;
  const std::size_t ours = config.robots.size();
  for (std::size_t i = 0; i < firmware.size(); ++i) {
    const bool other = i >= ours;
    const int id = other ? config.opponents.robot_ids[i - ours] : config.robot_ids[i];
    const RobotModel& model = other ? config.opponents.robots[i - ours] : config.robots[i];
    const std::size_t first = other ? ours : 0;  // of its team
    if (firmware[i] == nullptr) {
      problems.push_back(fmt::format("robot {}: the firmware could not be made", id));
      continue;
    }
    const std::int64_t period_ns = firmware[i]->control_period_ns();
    if (period_ns <= 0 || period_ns % config.plant.mechanical_step_ns != 0) {
      problems.push_back(
          fmt::format("robot {}: control period {} ns of firmware \"{}\" must be a multiple of the "
                      "mechanical step, {} ns",
                      id, period_ns, firmware[i]->name(), config.plant.mechanical_step_ns));
    }
    if (firmware[i]->drives_phases() && !electrics_of(model).three_phase()) {
      problems.push_back(fmt::format(
          "robot {}: firmware \"{}\" sets the legs of three phases; the model's drive.kind must be \"dq\" or "
          "\"switched\"",
          id, firmware[i]->name()));
    }
    if (firmware[first] != nullptr && firmware[i]->radio_format() != firmware[first]->radio_format()) {
      problems.push_back(fmt::format(
          "robot {}: its firmware decodes radio \"{}\", that of robot {} \"{}\"; behind one dongle "
          "they must agree",
          id, firmware[i]->radio_format(), other ? config.opponents.robot_ids[0] : config.robot_ids[0],
          firmware[first]->radio_format()));
    }
  }
  return problems;
}

std::string first_non_finite(const RobotSample& sample) {
  const auto each = [&](auto&& take) {
    const RobotSensors& s = sample.sensors;
    take("sensors motor_current_A", s.motor_current_A);
    take("sensors bus_voltage_V", s.bus_voltage_V);
    take("sensors gyro_z_rad_s", s.gyro_z_rad_s);
    take("sensors accel_x_m_s2", s.accel_x_m_s2);
    take("sensors accel_y_m_s2", s.accel_y_m_s2);
    take("drive duty_ratio", sample.drive.duty_ratio);
    take("feedback omega_wheel_rad_s", sample.feedback.omega_wheel_rad_s);
  };
  double rest = 0.0;  // x - x is 0 of a finite number, and of no other
  each([&](std::string_view, const auto& value) {
    if constexpr (std::is_floating_point_v<std::remove_cvref_t<decltype(value)>>) {
      rest += value - value;
    } else {
      for (const double x : value) rest += x - x;
    }
  });
  if (rest == 0.0) return {};
  FiniteScan scan;
  each([&](std::string_view name, const auto& value) { scan.check(name, value); });
  return scan.take();
}

void throw_problems(const std::vector<std::string>& problems) {
  if (!problems.empty()) throw std::invalid_argument(fmt::format("{}", fmt::join(problems, "\n")));
}

RobotConfig robot_config(const RobotModel& driven, int robot_id) {
  const RobotModel& model = driven.told ? *driven.told : driven;
  RobotConfig config{};
  config.robot_id = static_cast<std::uint32_t>(robot_id);
  for (std::size_t i = 0; i < kWheels; ++i) config.wheel_angle_rad[i] = model.wheel_angle_rad[i];
  config.wheel_radius_m = model.wheel_radius_m;
  config.wheel_center_radius_m = model.wheel_center_radius_m;
  config.gear_ratio = model.gear_ratio;
  // The firmware knows which way its encoders count: a negative count per turn says so.
  config.encoder_counts_per_rotor_turn = model.encoder.counts_per_turn * model.encoder.direction;
  config.bus_voltage_nominal_V = model.bus_voltage_V;
  config.motor_resistance_ohm = model.motor.resistance_ohm;
  config.motor_torque_constant_Nm_per_A = model.motor.torque_constant_Nm_per_A;
  config.command_timeout_s = model.control_timeout_s;
  return config;
}

}  // namespace omnihil
