/* The reference that hangs for ever in its 200th control interrupt after each reset. */
#include "tests/hil/scenario/firmware/wrapped.h"

static volatile uint32_t ticks;

static void tick(void* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  reference()->tick(state, sensors, drive);
  if (++ticks < 200u) return;
  for (;;) {
  }
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static omnihil_firmware_api api;
  api = *reference();
  api.name = "hangs";
  api.tick = tick;
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
