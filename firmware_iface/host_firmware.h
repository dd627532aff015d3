// Any firmware behind the C ABI, as an omnihil::Firmware.
//
//   std::unique_ptr<HostFirmware> firmware = make_reference_firmware(config);
//   RobotDrive drive = firmware->tick(sensors);      // every control_period_ns()
//   if (firmware->faults().total() > 0) …            // what the firmware asked for and did not get
//
// The firmware is not trusted: its table is checked once, every drive it gives is checked at every tick
// (firmware_checks.h).
// A robot with three-phase drives comes with a MotorConfig; a firmware with a motor_tick() then sets its
// legs. A leg that is asked for what no leg can do opens all three of its bridge for that PWM period, and is
// counted. Cannot: catch a firmware that crashes or never returns; it runs in this process. A team's library
// runs in one of its own (hil/firmware/guarded_firmware.h).
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/firmware_checks.h"
#include "firmware_iface/robot_io.h"

namespace omnihil {

class HostFirmware final : public CheckedFirmware {
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
};

// The reference firmware of firmware_iface/reference: duties; or, by field-oriented control or six-step
// commutation, the legs of three-phase bridges. Throw std::invalid_argument as above.
std::unique_ptr<HostFirmware> make_reference_firmware(const RobotConfig& config);
std::unique_ptr<HostFirmware> make_emotional_firmware(const RobotConfig& config);  // wheels by BELBIC
std::unique_ptr<HostFirmware> make_foc_firmware(const RobotConfig& config, const MotorConfig& motors);
std::unique_ptr<HostFirmware> make_six_step_firmware(const RobotConfig& config, const MotorConfig& motors);

}  // namespace omnihil
