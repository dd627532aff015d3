#include "tools/options/dataset_options.h"

namespace omnihil {

void add_dataset_firmware_options(Verb& verb, OtherFirmware& firmware) {
  verb.add_option("--firmware", firmware.file,
                  "library (.so) or microcontroller image that makes duties of a robot's commands in the "
                  "prediction, in place of the dataset's own (docs/radio-driven.md)");
  verb.add_option("--board", firmware.board, "board file of a microcontroller image");
  verb.add_option("--format", firmware.format,
                  "radio format of that board from this file (docs/radio/own-format.md)");
}

}  // namespace omnihil
