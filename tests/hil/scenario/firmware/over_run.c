/* A control interrupt that every 100th time takes 1.5 periods: the next one is lost. */
#include "tests/hil/scenario/firmware/wrapped.h"

typedef struct {
  uint64_t busy_until_us;
  uint32_t ticks;
  omnihil_drive held;
} late_state;

/* behind the reference's state, in the same block */
static late_state* late_of(void* state) {
  return (late_state*)((char*)state + ((reference()->state_bytes + 15u) & ~15u));
}

static void tick(void* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  late_state* late = late_of(state);
  if (sensors->now_us >= late->busy_until_us) {
    reference()->tick(state, sensors, &late->held);
    uint32_t took_us = ++late->ticks % 100u == 0u ? REFERENCE_PERIOD_US * 3u / 2u : 300u;
    late->busy_until_us = sensors->now_us + took_us;
  }
  *drive = late->held;
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static omnihil_firmware_api api;
  api = *reference();
  api.name = "control interrupt that over-runs";
  api.state_bytes = ((api.state_bytes + 15u) & ~15u) + (uint32_t)sizeof(late_state);
  api.tick = tick;
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
