/* What three Hall sensors tell: the sector of 60 electrical degrees, the direction, the speed.
 *
 *   six_step_hall hall;
 *   six_step_hall_reset(&hall);
 *   six_step_hall_update(&hall, code, 50e-6f);            // code = H1 + 2 H2 + 4 H3, once per tick
 *   float w = six_step_hall_omega_elec_rad_s(&hall);
 *
 * Sectors 0 .. 5 have the codes 3, 2, 6, 4, 5, 1 in the order of forward rotation; sector n is the 60 degrees
 * around 60 n. Speed: the edges of the last electrical turn over the time they took, so that unevenly placed
 * sensors do not show; falling when the next edge is later than it was in this sector a turn ago; zero after
 * 0.1 s without one, and from a reversal until the second edge after it.
 * A code of 0 or 7 is no sector: the last one is kept; six such reads in a row are a fault (wire off, supply
 * off) until a good read comes. A change by more than one sector is counted as skipped.
 * Cannot: a speed below one edge per 0.1 s; tell a glitch from an edge if its code is a neighbour's.
 */
#ifndef OMNIHIL_REFERENCE_SIX_STEP_HALL_H
#define OMNIHIL_REFERENCE_SIX_STEP_HALL_H

#ifdef __cplusplus
extern "C" {
#endif

#define SIX_STEP_HALL_EDGES 6

typedef struct six_step_hall {
  int sector;    /* 0 .. 5; -1: none seen yet */
  int direction; /* of the last edge: 1, -1; 0: none yet */
  float since_edge_s;
  float interval_s[SIX_STEP_HALL_EDGES]; /* before each of the last edges */
  int intervals, next;
  int bad_reads; /* in a row */
  unsigned skipped;
} six_step_hall;

void six_step_hall_reset(six_step_hall* hall);
void six_step_hall_update(six_step_hall* hall, int code, float dt_s);
float six_step_hall_omega_elec_rad_s(const six_step_hall* hall);
int six_step_hall_fault(const six_step_hall* hall);
int six_step_hall_sector(int code); /* -1: none */

#ifdef __cplusplus
}
#endif
#endif
