/* The difference of the counts of two control periods is held in 8 bits: right up to 127 counts a period. */
#include "tests/hil/scenario/firmware/wrapped.h"

static int32_t last[OMNIHIL_WHEELS], summed[OMNIHIL_WHEELS];

static void tick(void* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  omnihil_sensors seen = *sensors;
  for (int w = 0; w < OMNIHIL_WHEELS; ++w) {
    int32_t count = (int32_t)sensors->encoder_counts[w];
    summed[w] += (int8_t)(count - last[w]);
    last[w] = count;
    seen.encoder_counts[w] = summed[w];
  }
  reference()->tick(state, &seen, drive);
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static omnihil_firmware_api api;
  api = *reference();
  api.name = "count differences in 8 bits";
  api.tick = tick;
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
