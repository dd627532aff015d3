#include "firmware_iface/mcu/stm32/device.h"

namespace omnihil::mcu {

const DeviceKind* find_device(std::string_view name) {
  for (const DeviceKind* kind : all_devices()) {
    if (kind->name == name) return kind;
  }
  return nullptr;
}

}  // namespace omnihil::mcu
