/* Wheels 1 and 2 plugged in at each other's place, motor and encoder alike: every loop is stable. */
#include "tests/hil/scenario/firmware/wrapped.h"

enum { ONE = 1, OTHER = 2 };

static void tick(void* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  omnihil_sensors seen = *sensors;
  seen.encoder_counts[ONE] = sensors->encoder_counts[OTHER];
  seen.encoder_counts[OTHER] = sensors->encoder_counts[ONE];
  reference()->tick(state, &seen, drive);
  double duty_ratio = drive->duty_ratio[ONE];
  uint32_t mode = drive->mode[ONE];
  drive->duty_ratio[ONE] = drive->duty_ratio[OTHER];
  drive->mode[ONE] = drive->mode[OTHER];
  drive->duty_ratio[OTHER] = duty_ratio;
  drive->mode[OTHER] = mode;
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static omnihil_firmware_api api;
  api = *reference();
  api.name = "wheels 1 and 2 exchanged";
  api.tick = tick;
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
