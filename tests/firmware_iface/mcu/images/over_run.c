/* The reference with a control interrupt that every 100th time takes 2.5 periods: of the two that come
 * meanwhile the timer's flag keeps one. */
#include "tests/hil/scenario/firmware/wrapped.h"

static volatile uint32_t ticks;

static void tick(void* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  reference()->tick(state, sensors, drive);
  if (++ticks % 100u != 0u) return;
  volatile uint32_t* const timer = (volatile uint32_t*)0x40001024u; /* TIM6 counts microseconds, 0 to 999 */
  for (int half = 0; half < 5; ++half) {
    uint32_t from_us = *timer;
    while ((*timer + REFERENCE_PERIOD_US - from_us) % REFERENCE_PERIOD_US < REFERENCE_PERIOD_US / 2u) {
    }
  }
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static omnihil_firmware_api api;
  api = *reference();
  api.name = "control interrupt that over-runs";
  api.tick = tick;
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
