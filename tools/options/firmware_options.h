// The options with which a verb lets its user name a firmware: the same words for all of them.
//
//   add_firmware_options(verb, choice);               // --firmware, --board, --firmware-deadline
#pragma once
#include "hil/firmware/open_firmware.h"
#include "tools/command_line.h"

namespace omnihil {

void add_firmware_options(Verb& verb, FirmwareChoice& choice);

}  // namespace omnihil
