// Exit codes of `omnihil`, the same for every verb. Printed by `omnihil --help`.
#pragma once

namespace omnihil {

enum ExitCode : int {
  kExitOk = 0,             // did what was asked; for check and compare: agrees; scenario: all passed
  kExitDiffers = 1,        // check, compare: differs, the first difference is named; scenario: a check failed
  kExitBadInput = 2,       // unusable arguments, model, recording or packet; nothing was written
  kExitIo = 3,             // a device or file could not be opened, read or written
  kExitDiverged = 4,       // the simulated state stopped being finite, or a fault inside the program
  kExitLate = 5,           // real time was asked for with --strict and the host could not keep up
  kExitFirmware = 6,       // the firmware crashed, hung or ended its process; the bench went on
  kExitInterrupted = 130,  // Ctrl-C where it ends the work early; serve ends with 0
};

inline constexpr const char* kExitCodeHelp =
    "Exit codes:\n"
    "  0    did what was asked; check, compare: agrees; scenario: all checks passed\n"
    "  1    check: differs, the first difference is named; compare: outside a tolerance tube;\n"
    "       scenario: a check failed\n"
    "  2    unusable arguments, model, recording or packet; nothing was written\n"
    "  3    a device or file could not be opened, read or written\n"
    "  4    the simulated state stopped being finite, or a fault inside the program\n"
    "  5    real time was asked for with --strict and this computer could not keep up\n"
    "  6    the firmware crashed, hung or ended its process; what it was doing is said\n"
    "  130  interrupted before the work was done\n";

}  // namespace omnihil
