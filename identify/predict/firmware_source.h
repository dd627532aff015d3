// A robot's own firmware, to be run in the loop of a prediction: from here one comes as often as wanted, each as if just switched on.
//
//   std::unique_ptr<Firmware> firmware = dataset.firmware->fresh();
//   firmware->command(command, now_ns);  RobotDrive drive = firmware->tick(sensors);
//
// What two of them do depends on what each is told alone, whichever ran before, beside it or in another thread: whoever makes
// a source sees to that (hil/dataset/dataset_firmware.h).
#pragma once
#include <memory>

#include "firmware_iface/ports.h"

namespace omnihil {

class FirmwareSource {
 public:
  virtual ~FirmwareSource() = default;
  virtual std::unique_ptr<Firmware> fresh() const = 0;
  virtual double counts_per_rotor_turn() const = 0;  // of the encoders that it counts; below 0: they fall
};

}  // namespace omnihil
