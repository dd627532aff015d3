// What a firmware may ask for: its table, its robot's configuration and each of its answers, held to the
// boundary (omnihil_firmware.h). Pure; the same for a firmware in this process, in a guarded one, or emulated.
//
//   std::vector<std::string> problems = check_firmware_api(omnihil_firmware_get(OMNIHIL_FIRMWARE_ABI));
//   check_drive(drive, drives_phases, faults);       // a bad wheel coasts, and is counted
//
// A bridge request that is not a number, not within -1..1 or of no known mode turns that wheel to coast, and
// is counted. Nothing is clamped, and no value is passed on that hardware could not have taken.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
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

// A firmware whose answers were held to the boundary.
class CheckedFirmware : public Firmware {
 public:
  const FirmwareFaults& faults() const { return faults_; }

 protected:
  mutable FirmwareFaults faults_;
};

// Every fault of a firmware's table, one line each, naming the member; empty when it can be used.
std::vector<std::string> check_firmware_api(const omnihil_firmware_api* api);
// The table as far as the firmware knows it; the rest is null.
omnihil_firmware_api table_of(const omnihil_firmware_api* api);
// Every fault of a configuration that no firmware could work with, naming the field, its value and what is
// allowed.
std::vector<std::string> check_robot_config(const RobotConfig& config);

void check_drive(RobotDrive& drive, bool drives_phases, FirmwareFaults& faults);
void check_motor_drive(MotorDrive& drive, FirmwareFaults& faults);
void check_feedback(RobotFeedback& feedback, FirmwareFaults& faults);

// "title\n  fault\n  fault": how faults are told to a user.
std::string faults_text(std::string_view title, const std::vector<std::string>& faults);

}  // namespace omnihil
