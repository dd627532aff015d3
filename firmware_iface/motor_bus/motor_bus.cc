#include "firmware_iface/motor_bus/motor_bus.h"

namespace omnihil {

std::string_view to_string(BusVerdict verdict) {
  constexpr std::string_view kNames[] = {
      "ok",           "not ours",  "wrong kind of frame", "unknown command",
      "wrong length", "malformed", "not a finite number", "not supported"};
  return kNames[static_cast<std::size_t>(verdict)];
}

const MotorBusKind* find_motor_bus(std::string_view id) {
  for (const MotorBusKind* kind : motor_buses()) {
    if (kind->id == id) return kind;
  }
  return nullptr;
}

}  // namespace omnihil
