/* The reference firmware under another name, for firmwares that change one thing of it.
 *
 *   const omnihil_firmware_api* omnihil_firmware_get(uint32_t v) {
 *     static omnihil_firmware_api api;
 *     api = *reference();  api.name = "…";  api.tick = my_tick;
 *     return v == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
 *   }
 */
#ifndef OMNIHIL_TESTS_WRAPPED_H
#define OMNIHIL_TESTS_WRAPPED_H
#include <string.h>

#include "firmware_iface/reference/reference_firmware.h"

#define reference() omnihil_reference_firmware()

#endif
