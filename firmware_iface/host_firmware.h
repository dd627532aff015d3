// Any firmware behind the C ABI, as an omnihil::Firmware.
//
//   std::unique_ptr<HostFirmware> firmware = make_reference_firmware(config);
//   RobotDrive drive = firmware->tick(sensors);      // every control_period_ns()
//   if (firmware->faults().total() > 0) ...          // what the firmware asked for and did not get
//
// The firmware is not trusted: its table is checked once, every drive it gives is checked at every tick. A
// bridge request that is not a number, not within -1..1 or of no known mode turns that wheel to coast, and is
// counted. The bench never clamps a value and never passes one on that hardware could not have taken.
// A robot with three-phase drives comes with a MotorConfig; a firmware with a motor_tick() then sets its
// legs. A leg that is asked for what no leg can do opens all three of its bridge for that PWM period, and is
// counted. Cannot: catch a firmware that crashes or never returns; it runs in this process.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/ports.h"
#include "firmware_iface/robot_io.h"

namespace omnihil {

// What the firmware asked for and the bench refused, by cause. Per wheel and tick, not per tick.
struct FirmwareFaults {
  std::uint64_t duty_not_finite = 0;        // -> coast
  std::uint64_t duty_out_of_range = 0;      // outside -1..1 -> coast
  std::uint64_t drive_mode_unknown = 0;     // PHASES of a robot or firmware without: likewise -> coast
  std::uint64_t leg_duty_not_finite = 0;    // -> the wheel's three legs open
  std::uint64_t leg_duty_out_of_range = 0;  // outside 0..1 -> likewise
  std::uint64_t leg_unknown = 0;            // -> likewise
  std::uint64_t dribbler_invalid = 0;       // not finite or outside 0..1 -> 0
  std::uint64_t kick_invalid = 0;           // unknown kind, pulse not finite or negative -> no kick
  std::uint64_t feedback_not_finite = 0;    // values -> 0
  std::uint64_t frame_too_long = 0;         // radio_transmit claimed more than it was given -> dropped

  std::uint64_t total() const {
    return duty_not_finite + duty_out_of_range + drive_mode_unknown + leg_duty_not_finite +
           leg_duty_out_of_range + leg_unknown + dribbler_invalid + kick_invalid + feedback_not_finite +
           frame_too_long;
  }
  bool operator==(const FirmwareFaults&) const = default;
};

// Every fault of a firmware's table, one line each, naming the member; empty when it can be used.
std::vector<std::string> check_firmware_api(const omnihil_firmware_api* api);
// Every fault of a configuration that no firmware could work with, naming the field, its value and what is
// allowed.
std::vector<std::string> check_robot_config(const RobotConfig& config);

class HostFirmware final : public Firmware {
 public:
  // `api` must outlive this. Throws std::invalid_argument listing every fault of the table and of the
  // configuration, or saying with which code the firmware itself refused the configuration.
  // `motors`: of a robot with three-phase drives.
  HostFirmware(const omnihil_firmware_api* api, const RobotConfig& config,
               const std::optional<MotorConfig>& motors = std::nullopt);

  std::string_view name() const override;
  std::string_view radio_format() const override;
  std::int64_t control_period_ns() const override;
  void command(const RobotCommand& command, std::int64_t now_ns) override;
  void radio_receive(std::span<const std::uint8_t> frame, std::int64_t now_ns) override;
  std::size_t radio_transmit(std::span<std::uint8_t> out) override;
  bool set_gains(const RobotGains& gains) override;
  RobotGains gains() const override;
  RobotDrive tick(const RobotSensors& sensors) override;
  RobotFeedback feedback() const override;
  bool drives_phases() const override { return drives_phases_; }
  MotorDrive motor_tick(const MotorSensors& sensors) override;

  const FirmwareFaults& faults() const { return faults_; }
  // The firmware's state block as bytes. Valid for the same firmware in the same process only, and only for a
  // firmware that keeps no pointers into its block (the reference firmware keeps none).
  std::vector<std::byte> save() const;
  bool restore(std::span<const std::byte> state);  // false: other size, nothing changed

 private:
  struct FreeAligned {
    void operator()(std::byte* block) const { ::operator delete (block, std::align_val_t{kAlignment}); }
  };
  static constexpr std::size_t kAlignment = 64;

  omnihil_firmware_api api_;  // what the firmware's table lacks of it is null
  bool drives_phases_ = false;
  std::unique_ptr<std::byte, FreeAligned> state_;
  mutable FirmwareFaults faults_;
};

// The reference firmware of firmware_iface/reference: duties; or, by field-oriented control or six-step
// commutation, the legs of three-phase bridges. Throw std::invalid_argument as above.
std::unique_ptr<HostFirmware> make_reference_firmware(const RobotConfig& config);
std::unique_ptr<HostFirmware> make_foc_firmware(const RobotConfig& config, const MotorConfig& motors);
std::unique_ptr<HostFirmware> make_six_step_firmware(const RobotConfig& config, const MotorConfig& motors);

}  // namespace omnihil
