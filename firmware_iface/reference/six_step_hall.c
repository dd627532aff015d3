#include "firmware_iface/reference/six_step_hall.h"

#define SECTOR_RAD 1.04719755f /* pi / 3 */
#define STANDSTILL_S 0.1f
#define BAD_READS 6

int six_step_hall_sector(int code) {
  static const signed char sector[8] = {-1, 5, 1, 0, 3, 4, 2, -1};
  return sector[code & 7];
}

void six_step_hall_reset(six_step_hall* hall) {
  hall->sector = -1;
  hall->direction = 0;
  hall->since_edge_s = STANDSTILL_S;
  hall->intervals = 0;
  hall->next = 0;
  hall->bad_reads = 0;
  hall->skipped = 0;
}

static void take_edge(six_step_hall* hall, int direction) {
  if (direction != hall->direction || hall->since_edge_s >= STANDSTILL_S) {
    /* from rest or a reversal: the time since the last edge measures nothing */
    hall->intervals = 0;
    hall->next = 0;
  } else {
    hall->interval_s[hall->next] = hall->since_edge_s;
    hall->next = (hall->next + 1) % SIX_STEP_HALL_EDGES;
    if (hall->intervals < SIX_STEP_HALL_EDGES) ++hall->intervals;
  }
  hall->direction = direction;
  hall->since_edge_s = 0.0f;
}

void six_step_hall_update(six_step_hall* hall, int code, float dt_s) {
  int sector = six_step_hall_sector(code);
  if (hall->since_edge_s < STANDSTILL_S) hall->since_edge_s += dt_s;
  if (sector < 0) {
    if (hall->bad_reads < BAD_READS) ++hall->bad_reads;
    return;
  }
  hall->bad_reads = 0;
  if (hall->sector < 0) {
    hall->sector = sector;
    return;
  }
  int ahead = (sector - hall->sector + 6) % 6;
  if (ahead == 0) return;
  hall->sector = sector;
  if (ahead == 1) {
    take_edge(hall, 1);
  } else if (ahead == 5) {
    take_edge(hall, -1);
  } else {
    ++hall->skipped;
    hall->intervals = 0;
    hall->next = 0;
  }
}

float six_step_hall_omega_elec_rad_s(const six_step_hall* hall) {
  if (hall->intervals == 0 || hall->since_edge_s >= STANDSTILL_S) return 0.0f;
  float time_s = 0.0f;
  for (int k = 0; k < hall->intervals; ++k) time_s += hall->interval_s[k];
  float omega = (float)hall->intervals * SECTOR_RAD / time_s;
  /* no edge for longer than the same sector took a turn ago: so much slower it must be */
  float expected_s =
      hall->intervals == SIX_STEP_HALL_EDGES ? hall->interval_s[hall->next] : SECTOR_RAD / omega;
  if (hall->since_edge_s > expected_s) omega *= expected_s / hall->since_edge_s;
  return (float)hall->direction * omega;
}

int six_step_hall_fault(const six_step_hall* hall) { return hall->bad_reads >= BAD_READS; }
