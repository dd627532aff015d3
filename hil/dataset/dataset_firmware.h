// A team's firmware in the loop of predictions, library or image: loaded, tried out, and refused with the reason where it cannot
// serve.
//
//   std::vector<FirmwareRefusal> refused;
//   dataset.firmware = open_dataset_firmware({.file = "bench/libfw.so"}, robot_config(robot, 0), dataset.runs, refused);
//
// A library: predictions run it in this process, thousands of times, on several threads; each is a state block of its own,
// zeroed (omnihil_firmware.h). Before that it is tried: a second of commands in a process of its own, which may crash as it
// likes; then alone, again, and in turn with another one. All four have to ask the bridges for the same to the last bit: a
// library with variables outside of its block would make each prediction depend on the one before. Cannot: see state that a
// second of driving does not touch; contain a crash that comes later. An image: dataset_image.h.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "firmware_iface/robot_io.h"
#include "identify/predict/firmware_source.h"
#include "identify/record/dataset.h"

namespace omnihil {

// As dataset.toml names them; paths as they are opened.
struct DatasetFirmware {
  std::string file{};
  std::string board{};  // of an image
  std::string radio{};  // format that the commands were sent in; empty: not said
  double boot_s =
      1.0;  // an image has run so long, its robot at rest and its radio silent, when a record begins
};

// Key of dataset.toml that it is about, what is wrong, what is allowed.
struct FirmwareRefusal {
  std::string key, what, allowed;
};

// Null: `refused` says why. `runs`: whose commands it has to be told.
std::shared_ptr<const FirmwareSource> open_dataset_firmware(const DatasetFirmware& firmware,
                                                            const RobotConfig& config,
                                                            std::span<const Run> runs,
                                                            std::vector<FirmwareRefusal>& refused);

}  // namespace omnihil
