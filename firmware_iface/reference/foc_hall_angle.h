/* The electrical angle between Hall edges: from the edge on, with the speed of the last electrical turn.
 *
 *   float theta = foc_hall_angle_rad(&hall);            // after six_step_hall_update
 *
 * Law: forward the sector n was entered at 60 n - 30 degrees, backward at 60 n + 30; theta = edge + omega t,
 * never beyond the sector's other edge. Before the second edge: the sector's middle, wrong by 30 degrees at
 * most. Result in 0 .. 2 pi.
 */
#ifndef OMNIHIL_REFERENCE_FOC_HALL_ANGLE_H
#define OMNIHIL_REFERENCE_FOC_HALL_ANGLE_H

#include "firmware_iface/reference/six_step_hall.h"

#ifdef __cplusplus
extern "C" {
#endif

float foc_hall_angle_rad(const six_step_hall* hall);

#ifdef __cplusplus
}
#endif
#endif
