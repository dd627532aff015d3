// A team's shared object as an omnihil::Firmware, in a process of its own: whatever it does, the bench goes on.
//
//   GuardedFirmware firmware({.library = "./libmyteam.so"}, config);      // throws std::invalid_argument
//   RobotDrive drive = firmware.tick(sensors);          // coast once it is no more
//   firmware.failure();   // "./libmyteam.so crashed (SIGSEGV, a null pointer (+0 bytes)) in tick(), tick 1234 …"
//
// Contained and told: crashes, abort(), exit(), stack overflow, access outside the state block, a call that
// does not return within the deadline. One process per robot, so that a firmware with global variables serves
// a whole team. Its answers are checked as those of any other (firmware_checks.h).
// Cost: one exchange per control period, about 20 microseconds; a motor_tick() is one more each.
// Cannot: see writes within the state block or into the firmware's own globals; save and restore its state.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "firmware_iface/firmware_checks.h"
#include "firmware_iface/firmware_memory.h"
#include "hil/firmware/firmware_process.h"

namespace omnihil {

struct GuardedLibrary {
  std::string library;       // path of the shared object
  double deadline_s = 10.0;  // of wall time, for one call
};

class GuardedFirmware final : public CheckedFirmware, private FirmwareMemory {
 public:
  // std::invalid_argument: not a firmware, or it refused the robot, or it was gone before the first tick.
  GuardedFirmware(const GuardedLibrary& library, const RobotConfig& config,
                  const std::optional<MotorConfig>& motors = std::nullopt);

  std::string_view name() const override { return name_; }
  std::string_view radio_format() const override { return radio_; }
  std::int64_t control_period_ns() const override { return period_ns_; }
  void command(const RobotCommand& command, std::int64_t now_ns) override;
  void radio_receive(std::span<const std::uint8_t> frame, std::int64_t now_ns) override;
  std::size_t radio_transmit(std::span<std::uint8_t> out) override;
  bool set_gains(const RobotGains& gains) override;
  RobotGains gains() const override { return state_.gains; }
  RobotDrive tick(const RobotSensors& sensors) override;
  RobotFeedback feedback() const override { return state_.feedback; }
  bool drives_phases() const override { return drives_phases_; }
  MotorDrive motor_tick(const MotorSensors& sensors) override;
  std::string_view failure() const override { return failure_; }
  FirmwareMemory* memory() override { return this; }

 private:
  // FirmwareMemory
  bool read(std::span<const MemoryPiece> pieces, std::span<std::uint8_t> out) override;
  bool write(const MemoryPiece& piece, std::span<const std::uint8_t> bytes) override;
  void when_started(std::function<void()> work) override { work(); }
  std::uint64_t state_bytes() const override { return state_bytes_; }

  void load();
  bool take_state();  // the answer to a call; false: there is none any more
  void note_failure();

  FirmwareProcess process_;
  std::string library_, name_, radio_, failure_;
  std::int64_t period_ns_ = 0;
  std::uint64_t state_bytes_ = 0;
  bool has_motor_tick_ = false, drives_phases_ = false;
  WireTick state_;
  std::uint32_t next_frame_ = 0;
};

}  // namespace omnihil
