#include "firmware_iface/mcu/core/op.h"

namespace omnihil::mcu {
namespace {

struct Row {
  const char* name;
  int cycles;
};
constexpr Row kRows[] = {
#define OP(name, cycles) {#name, cycles},
#include "firmware_iface/mcu/core/op_codes.inc"
#undef OP
};

}  // namespace

int op_cycles(Code code) { return kRows[code].cycles; }
const char* op_name(Code code) { return kRows[code].name; }

}  // namespace omnihil::mcu
