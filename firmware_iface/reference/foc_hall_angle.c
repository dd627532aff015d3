#include "firmware_iface/reference/foc_hall_angle.h"

#include <math.h>

#define SECTOR_RAD 1.04719755f /* pi / 3 */
#define TURN_RAD 6.28318531f

float foc_hall_angle_rad(const six_step_hall* hall) {
  float middle_rad = (float)(hall->sector < 0 ? 0 : hall->sector) * SECTOR_RAD;
  float omega_rad_s = six_step_hall_omega_elec_rad_s(hall);
  float angle_rad = middle_rad;
  if (hall->intervals > 0 && omega_rad_s != 0.0f) {
    float way_rad = fminf(fabsf(omega_rad_s) * hall->since_edge_s, SECTOR_RAD);
    angle_rad += (float)hall->direction * (way_rad - 0.5f * SECTOR_RAD);
  }
  return angle_rad < 0.0f ? angle_rad + TURN_RAD : angle_rad;
}
