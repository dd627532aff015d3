#include "firmware_iface/reference/board_stm32f405/robot_page.h"

#include <string.h>

#include "firmware_iface/reference/robot_page_layout.h"

int robot_page_read(omnihil_robot_config* config) {
  const volatile robot_page* page = (const volatile robot_page*)0x08060000u;
  if (page->magic != ROBOT_PAGE_MAGIC) return 1;
  memset(config, 0, sizeof *config);
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) config->wheel_angle_rad[w] = (double)page->wheel_angle_rad[w];
  config->wheel_radius_m = (double)page->wheel_radius_m;
  config->wheel_center_radius_m = (double)page->wheel_center_radius_m;
  config->gear_ratio = (double)page->gear_ratio;
  config->encoder_counts_per_rotor_turn = (double)page->encoder_counts_per_rotor_turn;
  config->bus_voltage_nominal_V = (double)page->bus_voltage_nominal_V;
  config->motor_resistance_ohm = (double)page->motor_resistance_ohm;
  config->motor_torque_constant_Nm_per_A = (double)page->motor_torque_constant_Nm_per_A;
  config->command_timeout_s = (double)page->command_timeout_s;
  return 0;
}
