/* The reference firmware that sets the legs of its bridges itself, as a library. */
#include "firmware_iface/reference/phase_firmware.h"

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  return version == OMNIHIL_FIRMWARE_ABI ? omnihil_foc_firmware() : NULL;
}
