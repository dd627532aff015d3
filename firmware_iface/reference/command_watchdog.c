#include "firmware_iface/reference/command_watchdog.h"

static const double kDefaultTimeout_s = 0.25;
static const uint64_t kStopLimit_us = 1000000u;

static uint64_t elapsed_us(uint64_t since_us, uint64_t now_us) {
  return now_us > since_us ? now_us - since_us : 0u;
}

void command_watchdog_init(command_watchdog* watchdog, double timeout_s) {
  watchdog->timeout_us = (uint64_t)((timeout_s > 0.0 ? timeout_s : kDefaultTimeout_s) * 1e6 + 0.5);
  watchdog->phase = LINK_SILENT;
  watchdog->seen = 0;
}

void command_watchdog_feed(command_watchdog* watchdog, uint64_t now_us) {
  watchdog->fed_us = now_us;
  watchdog->phase = LINK_LIVE;
  watchdog->seen = 1;
}

link_phase command_watchdog_update(command_watchdog* watchdog, uint64_t now_us, int driven, int at_rest) {
  if (!watchdog->seen) {
    watchdog->fed_us = now_us;
    watchdog->seen = 1;
  }
  if (watchdog->phase == LINK_LIVE && elapsed_us(watchdog->fed_us, now_us) > watchdog->timeout_us) {
    watchdog->phase = driven ? LINK_STOPPING : LINK_SILENT;
    watchdog->stopping_us = now_us;
  } else if (watchdog->phase == LINK_STOPPING &&
             (at_rest || elapsed_us(watchdog->stopping_us, now_us) > kStopLimit_us)) {
    watchdog->phase = LINK_SILENT;
  }
  return watchdog->phase;
}

uint32_t command_watchdog_age_ms(const command_watchdog* watchdog, uint64_t now_us) {
  uint64_t age_ms = watchdog->seen ? elapsed_us(watchdog->fed_us, now_us) / 1000u : 0u;
  return age_ms < UINT32_MAX ? (uint32_t)age_ms : UINT32_MAX;
}
