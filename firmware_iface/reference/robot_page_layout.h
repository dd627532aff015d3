/* A robot's numbers in the flash or EEPROM of its board: magic "OMNI", then 32-bit floats. */
#ifndef OMNIHIL_REFERENCE_ROBOT_PAGE_LAYOUT_H
#define OMNIHIL_REFERENCE_ROBOT_PAGE_LAYOUT_H
#include "firmware_iface/omnihil_firmware.h"

#define ROBOT_PAGE_MAGIC 0x494E4D4Ful /* "OMNI" */

typedef struct {
  uint32_t magic;
  float wheel_angle_rad[OMNIHIL_WHEELS];
  float wheel_radius_m, wheel_center_radius_m, gear_ratio, encoder_counts_per_rotor_turn;
  float bus_voltage_nominal_V, motor_resistance_ohm, motor_torque_constant_Nm_per_A, command_timeout_s;
} robot_page;

#endif
