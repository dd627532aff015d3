/* Rotor speed from encoder counts: difference over one control period, then as little filter as the
 * encoder's resolution needs.
 *
 *   raw = 2 pi (counts - previous) / (counts_per_turn dt)          delay dt / 2
 *   one count in one period is a speed step q = 2 pi / (counts_per_turn dt); the filter's time constant
 *   dt (q / q_wanted - 1) brings it down to q_wanted, and is zero where q is already small.
 * Example: 4096 counts per turn, 1 ms: q = 1.53 rad/s at the rotor, no filter behind 3:1 and a 27 mm wheel.
 * Counters may start anywhere and wrap at 64 bits. A jump that no motor can make (a counter set to zero, a
 * flipped bit) is left out and counted; five in a row are an encoder fault and the wheel is let go.
 */
#ifndef OMNIHIL_REFERENCE_WHEEL_ENCODER_H
#define OMNIHIL_REFERENCE_WHEEL_ENCODER_H
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct encoder_setup {
  float rad_per_count;         /* negative where counts fall with positive rotation */
  float filter_s;              /* in the control loop */
  float report_filter_s;       /* of the reported speed and of the acceleration */
  float omega_rotor_max_rad_s; /* above it a jump is not a rotation */
} encoder_setup;

typedef struct wheel_encoder {
  int64_t counts;
  float omega_rotor_rad_s;          /* for the control loop */
  float omega_rotor_reported_rad_s; /* smoother, for telemetry */
  float accel_rotor_rad_s2;
  uint32_t jumps;     /* differences left out since init */
  uint32_t jumps_now; /* of them, in a row up to now */
  uint32_t primed;
} wheel_encoder;

void wheel_encoder_update(wheel_encoder* encoder, const encoder_setup* setup, int64_t counts, float dt_s);
int wheel_encoder_faulty(const wheel_encoder* encoder);

#ifdef __cplusplus
}
#endif
#endif
