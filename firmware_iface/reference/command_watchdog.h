/* What happens when the radio falls silent: live -> stopping -> silent.
 *
 *   live      a command that moves the robot came within the timeout
 *   stopping  it did not: the wheels brake to a stop under control, for at most 1 s
 *   silent    they stand, or 1 s is over: bridges off. Also the state before the first command.
 *
 * Default timeout 0.25 s. Robots of the league: 0.1 s (ibis), 0.2 s (A-Team), 0.5 s (ULaval, NAMeC); the
 * configuration overrides it. Example: at 1 m/s and 4 m/s^2 the robot stands 0.25 s after the timeout.
 */
#ifndef OMNIHIL_REFERENCE_COMMAND_WATCHDOG_H
#define OMNIHIL_REFERENCE_COMMAND_WATCHDOG_H
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum link_phase { LINK_SILENT = 0, LINK_LIVE = 1, LINK_STOPPING = 2 } link_phase;

typedef struct command_watchdog {
  uint64_t fed_us;      /* time of the last command; of the first tick while none came */
  uint64_t stopping_us; /* when stopping began */
  uint64_t timeout_us;
  link_phase phase;
  int seen; /* a time is known */
} command_watchdog;

void command_watchdog_init(command_watchdog* watchdog, double timeout_s);
void command_watchdog_feed(command_watchdog* watchdog, uint64_t now_us);
/* `driven`: bridges are on now; `at_rest`: the wheels stand and nothing is asked of them. */
link_phase command_watchdog_update(command_watchdog* watchdog, uint64_t now_us, int driven, int at_rest);
uint32_t command_watchdog_age_ms(const command_watchdog* watchdog, uint64_t now_us);

#ifdef __cplusplus
}
#endif
#endif
