// Options of all verbs that hold a model against a measurement.
//
//   add_dataset_firmware_options(verb, firmware);                  // --firmware, --board, --format
//   DatasetReading reading = read_dataset("bench/robot", "", firmware);
#pragma once
#include "hil/dataset/dataset_reader.h"
#include "tools/command_line.h"

namespace omnihil {

void add_dataset_firmware_options(Verb& verb, OtherFirmware& firmware);

}  // namespace omnihil
