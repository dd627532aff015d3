/* Wheel 2 wired the wrong way round, motor and encoder alike: its loop is stable and drives it backwards. */
#include "tests/hil/scenario/firmware/wrapped.h"

enum { WRONG = 2 };

static void tick(void* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  omnihil_sensors seen = *sensors;
  seen.encoder_counts[WRONG] = -seen.encoder_counts[WRONG];
  reference()->tick(state, &seen, drive);
  drive->duty_ratio[WRONG] = -drive->duty_ratio[WRONG];
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static omnihil_firmware_api api;
  api = *reference();
  api.name = "sign error on wheel 2";
  api.tick = tick;
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
