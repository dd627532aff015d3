// The firmware alone: fed with the sensors that were recorded, whatever its own duties would have done to the wheels.
//
//   const FirmwareAlone alone = run_firmware_alone(recording, options);
//   if (alone.why_not.empty()) first_drive_difference(recording, alone.answer);    // none: it answers as recorded
//
// In a closed loop one other duty changes every later sensor, so after a few ticks everything differs. Here commands
// and sensors are the recorded ones to the last tick: what differs is the firmware's doing, and what does not differ
// is not. Needs every tick recorded (serve --sample-every 1) and wheel duties; phases of three-phase bridges are not
// recorded, and a board on the desk reads its own encoders.
#pragma once
#include <string>

#include "hil/recording/replay_run.h"

namespace omnihil {

struct FirmwareAlone {
  std::string why_not;  // why it could not be done; empty: it was
  Recording answer;     // its duties, sample by sample; everything else in it has no meaning
};

// Throws as run_again does.
FirmwareAlone run_firmware_alone(const Recording& recording, const ReplayOptions& options);

}  // namespace omnihil
