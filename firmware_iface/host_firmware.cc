#include "firmware_iface/host_firmware.h"

#include <cstring>
#include <stdexcept>
#include <string_view>

#include "firmware_iface/reference/phase_firmware.h"
#include "firmware_iface/reference/reference_firmware.h"

namespace omnihil {
namespace {

std::uint64_t microseconds(std::int64_t now_ns) {
  return now_ns > 0 ? static_cast<std::uint64_t>(now_ns / 1000) : 0;
}

}  // namespace

HostFirmware::HostFirmware(const omnihil_firmware_api* api, const RobotConfig& config,
                           const std::optional<MotorConfig>& motors)
    : api_{} {
  std::vector<std::string> faults = check_firmware_api(api);
  if (!faults.empty())
    throw std::invalid_argument(faults_text("the firmware's table cannot be used:", faults));
  api_ = table_of(api);
  faults = check_robot_config(config);
  if (!faults.empty())
    throw std::invalid_argument(faults_text("the robot's configuration is not possible:", faults));
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
  check_motor_drive(drive, faults_);
  return drive;
}

RobotFeedback HostFirmware::feedback() const {
  RobotFeedback feedback{};
  api_.feedback(state_.get(), &feedback);
  check_feedback(feedback, faults_);
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

std::unique_ptr<HostFirmware> make_emotional_firmware(const RobotConfig& config) {
  return std::make_unique<HostFirmware>(omnihil_emotional_firmware(), config);
}

std::unique_ptr<HostFirmware> make_foc_firmware(const RobotConfig& config, const MotorConfig& motors) {
  return std::make_unique<HostFirmware>(omnihil_foc_firmware(), config, motors);
}

std::unique_ptr<HostFirmware> make_six_step_firmware(const RobotConfig& config, const MotorConfig& motors) {
  return std::make_unique<HostFirmware>(omnihil_six_step_firmware(), config, motors);
}

}  // namespace omnihil
