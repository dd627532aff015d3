/* What kind of robot this is: a page of flash that is programmed apart from the image (a board file:
 * [[flash]]).
 *
 *   omnihil_robot_config config;
 *   if (robot_page_read(&config) != 0) …      // erased or foreign page
 *
 * Words at 0x08060000: magic "OMNI", then 32-bit floats: four wheel angles (rad), wheel radius (m),
 * radius to the wheels (m), gear ratio, encoder counts per rotor turn (negative: they fall), nominal bus
 * voltage (V), motor resistance (ohm), torque constant (Nm/A), command timeout (s; 0: the firmware's own).
 */
#ifndef OMNIHIL_REFERENCE_ROBOT_PAGE_H
#define OMNIHIL_REFERENCE_ROBOT_PAGE_H
#include "firmware_iface/omnihil_firmware.h"

int robot_page_read(omnihil_robot_config* config);

#endif
