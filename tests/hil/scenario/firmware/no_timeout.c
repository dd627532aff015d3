/* Knows no end of a command: an hour instead of a quarter of a second. */
#include "tests/hil/scenario/firmware/wrapped.h"

static int init(void* state, const omnihil_robot_config* config) {
  omnihil_robot_config longer = *config;
  longer.command_timeout_s = 3600.0;
  return reference()->init(state, &longer);
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static omnihil_firmware_api api;
  api = *reference();
  api.name = "missing timeout";
  api.init = init;
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
