#include "firmware_iface/mcu/board/wheel_dialect.h"

namespace omnihil::mcu {

const WheelDialect* find_wheel_dialect(std::string_view name) {
  for (const WheelDialect* dialect : all_wheel_dialects()) {
    if (dialect->name == name) return dialect;
  }
  return nullptr;
}

}  // namespace omnihil::mcu
