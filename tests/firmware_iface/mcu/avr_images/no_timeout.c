/* Knows no end of a command: an hour instead of a quarter of a second. */
#include "firmware_iface/reference/command_watchdog.h"

void __real_command_watchdog_init(command_watchdog* watchdog, double timeout_s);
void __wrap_command_watchdog_init(command_watchdog* watchdog, double timeout_s);

void __wrap_command_watchdog_init(command_watchdog* watchdog, double timeout_s) {
  (void)timeout_s;
  __real_command_watchdog_init(watchdog, 3600.0);
}
