#include "firmware_iface/host_firmware.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "firmware_iface/reference/phase_firmware.h"
#include "firmware_iface/reference/reference_firmware.h"

namespace omnihil {
namespace {

constexpr std::uint32_t kLargestState_bytes = 16u << 20;
constexpr std::uint32_t kLongestPeriod_us = 1'000'000;

std::string joined(std::string_view title, const std::vector<std::string>& faults) {
  std::string text(title);
  for (const std::string& fault : faults) text += "\n  " + fault;
  return text;
}

template <class T>
std::string line(std::string_view name, T value, std::string_view allowed) {
  std::ostringstream text;
  text << name << " = " << value << ": " << allowed;
  return text.str();
}

std::uint64_t microseconds(std::int64_t now_ns) {
  return now_ns > 0 ? static_cast<std::uint64_t>(now_ns / 1000) : 0;
}

// Fields after the flags are doubles without a gap (checked by the layout test).
constexpr std::size_t kFeedbackDoublesAt = offsetof(RobotFeedback, battery_V);
constexpr std::size_t kFeedbackDoubles = (sizeof(RobotFeedback) - kFeedbackDoublesAt) / sizeof(double);

// Tables of firmwares from before there were three-phase motors end here.
constexpr std::size_t kFirstTableBytes = offsetof(omnihil_firmware_api, motor_init);

omnihil_firmware_api table_of(const omnihil_firmware_api* api) {
  omnihil_firmware_api table{};
  std::memcpy(&table, api, std::min<std::size_t>(api->struct_bytes, sizeof table));
  return table;
}

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

HostFirmware::HostFirmware(const omnihil_firmware_api* api, const RobotConfig& config,
                           const std::optional<MotorConfig>& motors)
    : api_{} {
  std::vector<std::string> faults = check_firmware_api(api);
  if (!faults.empty()) throw std::invalid_argument(joined("the firmware's table cannot be used:", faults));
  api_ = table_of(api);
  faults = check_robot_config(config);
  if (!faults.empty())
    throw std::invalid_argument(joined("the robot's configuration is not possible:", faults));
  state_.reset(static_cast<std::byte*>(::operator new (api_.state_bytes, std::align_val_t{kAlignment})));
  std::memset(state_.get(), 0, api_.state_bytes);
  drives_phases_ = motors.has_value() && api_.motor_tick != nullptr;
  int refusal = api_.init(state_.get(), &config);
  if (refusal == 0 && drives_phases_) refusal = api_.motor_init(state_.get(), &*motors);
  if (refusal != 0) {
    throw std::invalid_argument("firmware '" + std::string(name()) + "' refused the configuration of robot " +
                                std::to_string(config.robot_id) + " with code " + std::to_string(refusal));
  }
}

std::string_view HostFirmware::name() const { return api_.name; }

std::string_view HostFirmware::radio_format() const {
  return api_.radio_format == nullptr ? std::string_view() : std::string_view(api_.radio_format);
}

std::int64_t HostFirmware::control_period_ns() const {
  return static_cast<std::int64_t>(api_.control_period_us) * 1000;
}

void HostFirmware::command(const RobotCommand& command, std::int64_t now_ns) {
  api_.command(state_.get(), &command, microseconds(now_ns));
}

void HostFirmware::radio_receive(std::span<const std::uint8_t> frame, std::int64_t now_ns) {
  if (api_.radio_receive == nullptr) return;
  api_.radio_receive(state_.get(), frame.data(), frame.size(), microseconds(now_ns));
}

std::size_t HostFirmware::radio_transmit(std::span<std::uint8_t> out) {
  if (api_.radio_transmit == nullptr) return 0;
  const std::size_t size = api_.radio_transmit(state_.get(), out.data(), out.size());
  if (size <= out.size()) return size;
  ++faults_.frame_too_long;
  return 0;
}

bool HostFirmware::set_gains(const RobotGains& gains) { return api_.set_gains(state_.get(), &gains) == 0; }

RobotGains HostFirmware::gains() const {
  RobotGains gains{};
  api_.get_gains(state_.get(), &gains);
  return gains;
}

RobotDrive HostFirmware::tick(const RobotSensors& sensors) {
  RobotDrive drive{};
  api_.tick(state_.get(), &sensors, &drive);
  check_drive(drive, drives_phases_, faults_);
  return drive;
}

MotorDrive HostFirmware::motor_tick(const MotorSensors& sensors) {
  MotorDrive drive{};
  if (!drives_phases_) return drive;
  api_.motor_tick(state_.get(), &sensors, &drive);
  for (int wheel = 0; wheel < kWheels; ++wheel) check_legs(wheel, drive, faults_);
  return drive;
}

RobotFeedback HostFirmware::feedback() const {
  RobotFeedback feedback{};
  api_.feedback(state_.get(), &feedback);
  double values[kFeedbackDoubles];
  auto* bytes = reinterpret_cast<std::byte*>(&feedback) + kFeedbackDoublesAt;
  std::memcpy(values, bytes, sizeof values);
  for (double& value : values) {
    if (std::isfinite(value)) continue;
    value = 0.0;
    ++faults_.feedback_not_finite;
  }
  std::memcpy(bytes, values, sizeof values);
  return feedback;
}

std::vector<std::byte> HostFirmware::save() const { return {state_.get(), state_.get() + api_.state_bytes}; }

bool HostFirmware::restore(std::span<const std::byte> state) {
  if (state.size() != api_.state_bytes) return false;
  std::memcpy(state_.get(), state.data(), state.size());
  return true;
}

std::unique_ptr<HostFirmware> make_reference_firmware(const RobotConfig& config) {
  return std::make_unique<HostFirmware>(omnihil_reference_firmware(), config);
}

std::unique_ptr<HostFirmware> make_foc_firmware(const RobotConfig& config, const MotorConfig& motors) {
  return std::make_unique<HostFirmware>(omnihil_foc_firmware(), config, motors);
}

std::unique_ptr<HostFirmware> make_six_step_firmware(const RobotConfig& config, const MotorConfig& motors) {
  return std::make_unique<HostFirmware>(omnihil_six_step_firmware(), config, motors);
}

}  // namespace omnihil
