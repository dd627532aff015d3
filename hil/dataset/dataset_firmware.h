// A team's firmware library in the loop of predictions: loaded, tried out, and refused with the reason where it cannot serve.
//
//   std::string problem;
//   dataset.firmware = open_dataset_firmware("bench/libfw.so", robot_config(robot, 0), problem);    // null: `problem`
//
// Predictions run the library in this process, thousands of times, on several threads; each is a state block of its own, zeroed
// (omnihil_firmware.h). Before that it is tried: a second of commands in a process of its own, which may crash as it likes;
// then alone, again, and in turn with another one. All four have to ask the bridges for the same to the last bit: a library
// with variables outside of its block would make each prediction depend on the one before. Cannot: see state that a second
// of driving does not touch; contain a crash that comes later.
#pragma once
#include <memory>
#include <string>

#include "firmware_iface/robot_io.h"
#include "identify/predict/firmware_source.h"

namespace omnihil {

std::shared_ptr<const FirmwareSource> open_dataset_firmware(const std::string& file,
                                                            const RobotConfig& config, std::string& problem);

}  // namespace omnihil
