#include "hil/firmware/guarded_firmware.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace omnihil {

GuardedFirmware::GuardedFirmware(const GuardedLibrary& library, const RobotConfig& config,
                                 const std::optional<MotorConfig>& motors)
    : process_(library.deadline_s), library_(library.library) {
  const std::vector<std::string> faults = check_robot_config(config);
  if (!faults.empty())
    throw std::invalid_argument(faults_text("the robot's configuration is not possible:", faults));
  load();
  drives_phases_ = motors.has_value() && has_motor_tick_;
  WireStart start;
  start.config = config;
  start.has_motors = drives_phases_ ? 1 : 0;
  if (motors) start.motors = *motors;
  process_.send({.call = FirmwareCall::kInit}, &start, sizeof start);
  if (!take_state()) throw std::invalid_argument(failure_);
  if (state_.code != 0) {
    throw std::invalid_argument("firmware '" + name_ + "' refused the configuration of robot " +
                                std::to_string(config.robot_id) + " with code " +
                                std::to_string(state_.code));
  }
}

void GuardedFirmware::load() {
  // a path without a slash would be looked up among the system's libraries
  const std::string path = std::filesystem::absolute(library_).string();
  process_.send({.call = FirmwareCall::kLoad}, path.data(), path.size());
  const std::span<const std::uint8_t> answer = process_.receive();
  note_failure();
  if (!failure_.empty()) throw std::invalid_argument(failure_);
  WireLoaded loaded{};
  std::memcpy(&loaded, answer.data(), std::min(answer.size(), sizeof loaded));
  const std::string_view text(loaded.text, kWireTextBytes);
  if (loaded.problem_bytes > 0) {
    throw std::invalid_argument("firmware " + library_ + ": " +
                                std::string(text.substr(0, loaded.problem_bytes)));
  }
  name_ = text.substr(0, loaded.name_bytes);
  radio_ = text.substr(std::min<std::size_t>(loaded.name_bytes, text.size()), loaded.radio_bytes);
  period_ns_ = std::int64_t{loaded.control_period_us} * 1000;
  state_bytes_ = loaded.state_bytes;
  has_motor_tick_ = loaded.has_motor_tick != 0;
}

void GuardedFirmware::note_failure() {
  if (failure_.empty() && !process_.end().empty()) failure_ = library_ + " " + process_.end();
}

bool GuardedFirmware::take_state() {
  const std::span<const std::uint8_t> answer = process_.receive();
  note_failure();
  if (!failure_.empty()) return false;
  std::memcpy(&state_, answer.data(), std::min(answer.size(), sizeof state_));
  state_.frames = std::min<std::uint32_t>(state_.frames, kWireFrames);
  next_frame_ = 0;
  faults_.frame_too_long += state_.frames_refused;
  check_feedback(state_.feedback, faults_);
  return true;
}

void GuardedFirmware::command(const RobotCommand& command, std::int64_t now_ns) {
  process_.send({.call = FirmwareCall::kCommand, .now_ns = now_ns}, &command, sizeof command);
  note_failure();
}

void GuardedFirmware::radio_receive(std::span<const std::uint8_t> frame, std::int64_t now_ns) {
  process_.send({.call = FirmwareCall::kRadioReceive, .now_ns = now_ns}, frame.data(), frame.size());
  note_failure();
}

std::size_t GuardedFirmware::radio_transmit(std::span<std::uint8_t> out) {
  while (failure_.empty() && next_frame_ < state_.frames) {
    const WireFrame& frame = state_.frame[next_frame_++];
    if (frame.bytes <= std::min(out.size(), kWireFrameBytes)) {
      std::copy_n(frame.data, frame.bytes, out.begin());
      return frame.bytes;
    }
    ++faults_.frame_too_long;
  }
  return 0;
}

bool GuardedFirmware::set_gains(const RobotGains& gains) {
  process_.send({.call = FirmwareCall::kSetGains}, &gains, sizeof gains);
  return take_state() && state_.code == 0;
}

bool GuardedFirmware::read(std::span<const MemoryPiece> pieces, std::span<std::uint8_t> out) {
  process_.send({.call = FirmwareCall::kPeek}, pieces.data(), pieces.size_bytes());
  const std::span<const std::uint8_t> answer = process_.receive();
  note_failure();
  if (answer.size() != out.size() + 1 || answer[0] != 1) return false;
  std::ranges::copy(answer.subspan(1), out.begin());
  return true;
}

bool GuardedFirmware::write(const MemoryPiece& piece, std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> body(sizeof piece + bytes.size());
  std::memcpy(body.data(), &piece, sizeof piece);
  std::ranges::copy(bytes, body.begin() + sizeof piece);
  process_.send({.call = FirmwareCall::kPoke}, body.data(), body.size());
  const std::span<const std::uint8_t> answer = process_.receive();
  note_failure();
  return !answer.empty() && answer[0] == 1;
}

RobotDrive GuardedFirmware::tick(const RobotSensors& sensors) {
  process_.send({.call = FirmwareCall::kTick}, &sensors, sizeof sensors);
  if (!take_state()) return {};
  RobotDrive drive = state_.drive;
  check_drive(drive, drives_phases_, faults_);
  return drive;
}

MotorDrive GuardedFirmware::motor_tick(const MotorSensors& sensors) {
  MotorDrive drive{};
  if (!drives_phases_) return drive;
  process_.send({.call = FirmwareCall::kMotorTick}, &sensors, sizeof sensors);
  const std::span<const std::uint8_t> answer = process_.receive();
  note_failure();
  if (answer.size() < sizeof drive) return drive;
  std::memcpy(&drive, answer.data(), sizeof drive);
  check_motor_drive(drive, faults_);
  return drive;
}

}  // namespace omnihil
