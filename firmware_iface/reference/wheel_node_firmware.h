/* Four wheel nodes as one robot's firmware: the host build of what runs on a board per wheel.
 *
 *   const omnihil_firmware_api* api = omnihil_wheel_node_firmware();
 *
 * Each node gets every byte of the radio and its own wheel's counts, in the order of the wheels; a plan is
 * made at once when it is due, where a board's main loop has 8 ms for it.
 */
#ifndef OMNIHIL_REFERENCE_WHEEL_NODE_FIRMWARE_H
#define OMNIHIL_REFERENCE_WHEEL_NODE_FIRMWARE_H
#include "firmware_iface/omnihil_firmware.h"

#ifdef __cplusplus
extern "C" {
#endif

const omnihil_firmware_api* omnihil_wheel_node_firmware(void);

#ifdef __cplusplus
}
#endif
#endif
