/* What kind of robot this is, and which of its wheels: EEPROM and switches.
 *
 * EEPROM from 0: magic "OMNI", then 32-bit floats: four wheel angles (rad), wheel radius (m), radius to the
 * wheels (m), gear ratio, encoder counts per rotor turn (negative: they fall), nominal bus voltage (V), motor
 * resistance (ohm), torque constant (Nm/A), command timeout (s; 0: the firmware's own). */
#include <avr/eeprom.h>
#include <avr/io.h>
#include <string.h>

#include "firmware_iface/reference/board_atmega328p/board.h"
#include "firmware_iface/reference/robot_page_layout.h"

uint8_t board_wheel(void) { return PINC & 3u; }

int board_config(omnihil_robot_config* config) {
  robot_page page;
  eeprom_read_block(&page, (const void*)0, sizeof page);
  if (page.magic != ROBOT_PAGE_MAGIC) return 1;
  memset(config, 0, sizeof *config);
  for (uint8_t w = 0; w < OMNIHIL_WHEELS; ++w) config->wheel_angle_rad[w] = page.wheel_angle_rad[w];
  config->robot_id = PINC >> 2 & 0xFu;
  config->wheel_radius_m = page.wheel_radius_m;
  config->wheel_center_radius_m = page.wheel_center_radius_m;
  config->gear_ratio = page.gear_ratio;
  config->encoder_counts_per_rotor_turn = page.encoder_counts_per_rotor_turn;
  config->bus_voltage_nominal_V = page.bus_voltage_nominal_V;
  config->motor_resistance_ohm = page.motor_resistance_ohm;
  config->motor_torque_constant_Nm_per_A = page.motor_torque_constant_Nm_per_A;
  config->command_timeout_s = page.command_timeout_s;
  return 0;
}
