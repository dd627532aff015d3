#include "tools/options/firmware_options.h"

namespace omnihil {

void add_firmware_options(Verb& verb, FirmwareChoice& choice) {
  verb.add_option(
      "--firmware", choice.file,
      "a shared object of this computer (docs/firmware.md), a microcontroller image "
      "(docs/mcu-boards.md) or a board on the desk by its wire, such as serial:/dev/ttyACM0 "
      "(docs/remote-mcu.md, omnihil wires); without it, or with reference: the reference firmware");
  verb.add_option("--board", choice.board, "board file of a microcontroller image");
  verb.add_option("--firmware-deadline", choice.deadline_s,
                  "a call of the firmware that takes longer (s of wall time) is a hang")
      .capture_default_str();
}

}  // namespace omnihil
