// The loop of execute.cc once more, with a look at every instruction: apart, so that the other one is not asked whether
// anybody looks.
#define OMNIHIL_OBSERVED
#include "firmware_iface/mcu/core/execute.cc"  // NOLINT(bugprone-suspicious-include)
