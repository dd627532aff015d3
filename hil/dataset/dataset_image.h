// A team's firmware as a microcontroller image, on emulated boards in the loop of predictions.
//
//   std::vector<FirmwareRefusal> refused;
//   dataset.firmware = open_dataset_image({.file = "fw.elf", .board = "board.toml"}, robot_config(robot, 0), dataset.runs, refused);
//
// Each prediction has boards of its own, switched on boot_s before its record begins, with shafts that stand where they will
// begin to turn; their clock goes one control period a tick (mcu_firmware.h). Commands reach the image as frames of its
// board's radio format (hil/loop/radio_front.h), all of what is late about them in the model's controller.latency_s; boards
// that are told wheel speeds get them so. Wheel speeds that the image tells by its radio are those that the record's are
// compared with (booted_image.h); of one that tells none the shafts' own, behind the model's controller.report_filter_s.
// Ports are not opened, memory cards not written. Before that it is tried for half a second or so.
// Cannot: boards that set the legs of three-phase bridges; read other channels of a record (gyro_z, bus_voltage) out of the
// image's telemetry.
#pragma once
#include "hil/dataset/dataset_firmware.h"

namespace omnihil {

std::shared_ptr<const FirmwareSource> open_dataset_image(const DatasetFirmware& firmware,
                                                         const RobotConfig& config, std::span<const Run> runs,
                                                         std::vector<FirmwareRefusal>& refused);

}  // namespace omnihil
