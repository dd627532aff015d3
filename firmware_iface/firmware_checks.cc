#include "firmware_iface/firmware_checks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

namespace omnihil {
namespace {

constexpr std::uint32_t kLargestState_bytes = 16u << 20;
constexpr std::uint32_t kLongestPeriod_us = 1'000'000;

template <class T>
std::string line(std::string_view name, T value, std::string_view allowed) {
  std::ostringstream text;
  text << name << " = " << value << ": " << allowed;
  return text.str();
}

// Fields after the flags are doubles without a gap (checked by the layout test).
constexpr std::size_t kFeedbackDoublesAt = offsetof(RobotFeedback, battery_V);
constexpr std::size_t kFeedbackDoubles = (sizeof(RobotFeedback) - kFeedbackDoublesAt) / sizeof(double);

// Tables of firmwares from before there were three-phase motors end here.
constexpr std::size_t kFirstTableBytes = offsetof(omnihil_firmware_api, motor_init);

void check_wheel(int wheel, bool phases, RobotDrive& drive, FirmwareFaults& faults) {
  const double duty = drive.duty_ratio[wheel];
  const std::uint32_t mode = drive.mode[wheel];
  if (mode == OMNIHIL_DRIVE_COAST || (mode == OMNIHIL_DRIVE_PHASES && phases)) {
    drive.duty_ratio[wheel] = 0.0;  // means nothing there
    return;
  }
  if (mode != OMNIHIL_DRIVE_DUTY) {
    ++faults.drive_mode_unknown;
  } else if (!std::isfinite(duty)) {
    ++faults.duty_not_finite;
  } else if (duty < -1.0 || duty > 1.0) {
    ++faults.duty_out_of_range;
  } else {
    return;
  }
  drive.mode[wheel] = OMNIHIL_DRIVE_COAST;
  drive.duty_ratio[wheel] = 0.0;
}

void check_legs(int wheel, MotorDrive& drive, FirmwareFaults& faults) {
  bool good = true;
  for (int x = 0; x < kLegs && good; ++x) {
    const double duty = drive.leg_duty_ratio[wheel][x];
    std::uint64_t* fault = nullptr;
    if (drive.leg[wheel][x] > OMNIHIL_LEG_LOW) {
      fault = &faults.leg_unknown;
    } else if (!std::isfinite(duty)) {
      fault = &faults.leg_duty_not_finite;
    } else if (duty < 0.0 || duty > 1.0) {
      fault = &faults.leg_duty_out_of_range;
    }
    if (fault == nullptr) continue;
    ++*fault;
    good = false;
  }
  for (int x = 0; x < kLegs && !good; ++x) {
    drive.leg[wheel][x] = OMNIHIL_LEG_OFF;
    drive.leg_duty_ratio[wheel][x] = 0.0;
  }
}

}  // namespace

std::vector<std::string> check_firmware_api(const omnihil_firmware_api* api) {
  if (api == nullptr) return {"omnihil_firmware_get returned NULL: it does not serve this ABI version"};
  std::vector<std::string> faults;
  if (api->abi_version != OMNIHIL_FIRMWARE_ABI) {
    faults.push_back(
        line("abi_version", api->abi_version, "must be " + std::to_string(OMNIHIL_FIRMWARE_ABI)));
    return faults;  // the rest may mean anything
  }
  if (api->struct_bytes < kFirstTableBytes) {
    faults.push_back(line("struct_bytes", api->struct_bytes,
                          "must be at least " + std::to_string(kFirstTableBytes) +
                              "; compile the firmware against this omnihil_firmware.h"));
    return faults;
  }
  if (api->name == nullptr) faults.push_back("name is NULL");
  if (api->control_period_us == 0 || api->control_period_us > kLongestPeriod_us) {
    faults.push_back(line("control_period_us", api->control_period_us, "must be 1 to 1000000"));
  }
  if (api->state_bytes == 0 || api->state_bytes > kLargestState_bytes) {
    faults.push_back(
        line("state_bytes", api->state_bytes, "must be 1 to " + std::to_string(kLargestState_bytes)));
  }
  const auto require = [&faults](bool present, std::string_view name) {
    if (!present) faults.push_back(std::string(name) + " is NULL");
  };
  require(api->init != nullptr, "init");
  require(api->command != nullptr, "command");
  require(api->set_gains != nullptr, "set_gains");
  require(api->get_gains != nullptr, "get_gains");
  require(api->tick != nullptr, "tick");
  require(api->feedback != nullptr, "feedback");
  if (api->radio_format != nullptr) {
    require(api->radio_receive != nullptr, "radio_receive (radio_format is set)");
    require(api->radio_transmit != nullptr, "radio_transmit (radio_format is set)");
  }
  const omnihil_firmware_api table = table_of(api);
  if ((table.motor_init == nullptr) != (table.motor_tick == nullptr)) {
    faults.push_back(table.motor_init == nullptr ? "motor_init is NULL (motor_tick is set)"
                                                 : "motor_tick is NULL (motor_init is set)");
  }
  return faults;
}

std::vector<std::string> check_robot_config(const RobotConfig& config) {
  std::vector<std::string> faults;
  const auto positive = [&faults](double value, std::string_view name) {
    if (!(std::isfinite(value) && value > 0.0)) faults.push_back(line(name, value, "must be above 0"));
  };
  positive(config.wheel_radius_m, "wheel_radius_m");
  positive(config.wheel_center_radius_m, "wheel_center_radius_m");
  positive(config.gear_ratio, "gear_ratio");
  const double counts = config.encoder_counts_per_rotor_turn;
  if (!std::isfinite(counts) || counts == 0.0) {
    faults.push_back(line("encoder_counts_per_rotor_turn", counts,
                          "must not be 0; below 0: counts fall with positive rotation"));
  }
  positive(config.bus_voltage_nominal_V, "bus_voltage_nominal_V");
  positive(config.motor_resistance_ohm, "motor_resistance_ohm");
  positive(config.motor_torque_constant_Nm_per_A, "motor_torque_constant_Nm_per_A");
  for (int wheel = 0; wheel < kWheels; ++wheel) {
    if (!std::isfinite(config.wheel_angle_rad[wheel])) {
      faults.push_back(line("wheel_angle_rad[" + std::to_string(wheel) + "]", config.wheel_angle_rad[wheel],
                            "must be a number"));
    }
  }
  if (!(config.command_timeout_s >= 0.0 && config.command_timeout_s <= 3600.0)) {
    faults.push_back(
        line("command_timeout_s", config.command_timeout_s, "must be 0 (the firmware's own) to 3600"));
  }
  return faults;
}

omnihil_firmware_api table_of(const omnihil_firmware_api* api) {
  omnihil_firmware_api table{};
  std::memcpy(&table, api, std::min<std::size_t>(api->struct_bytes, sizeof table));
  return table;
}

void check_drive(RobotDrive& drive, bool phases, FirmwareFaults& faults) {
  for (int wheel = 0; wheel < kWheels; ++wheel) check_wheel(wheel, phases, drive, faults);
  if (!(drive.dribbler_ratio >= 0.0 && drive.dribbler_ratio <= 1.0)) {
    ++faults.dribbler_invalid;
    drive.dribbler_ratio = 0.0;
  }
  if (drive.kick > OMNIHIL_KICK_CHIP || !std::isfinite(drive.kick_pulse_s) || drive.kick_pulse_s < 0.0) {
    ++faults.kick_invalid;
    drive.kick = OMNIHIL_KICK_NONE;
    drive.kick_pulse_s = 0.0;
  }
}

void check_motor_drive(MotorDrive& drive, FirmwareFaults& faults) {
  for (int wheel = 0; wheel < kWheels; ++wheel) check_legs(wheel, drive, faults);
}

void check_feedback(RobotFeedback& feedback, FirmwareFaults& faults) {
  double values[kFeedbackDoubles];
  auto* bytes = reinterpret_cast<std::byte*>(&feedback) + kFeedbackDoublesAt;
  std::memcpy(values, bytes, sizeof values);
  for (double& value : values) {
    if (std::isfinite(value)) continue;
    value = 0.0;
    ++faults.feedback_not_finite;
  }
  std::memcpy(bytes, values, sizeof values);
}

std::string faults_text(std::string_view title, const std::vector<std::string>& faults) {
  std::string text(title);
  for (const std::string& fault : faults) text += "\n  " + fault;
  return text;
}

}  // namespace omnihil
