// What a Cortex-M0+ takes longer for than the table of op_codes.inc says (DDI 0484C table 3-1): stores 2 cycles, MRS and MSR 3,
// BL and POP with the PC, with their branch, 3 and 3 + N.
//
//   cycles = op_cycles(kStrImm) + more_on_plus(kStrImm);      // 2
#pragma once
#include "firmware_iface/mcu/core/op.h"

namespace omnihil::mcu {

inline int more_on_plus(Code code) {
  switch (code) {
    case kStrImm:
    case kStrReg:
    case kStrbImm:
    case kStrbReg:
    case kStrhImm:
    case kStrhReg:
    case kBl:
    case kPopPc:
    case kMsr:
    case kMrs:
      return 1;
    default:
      return 0;
  }
}

}  // namespace omnihil::mcu
