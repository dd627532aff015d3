/* The P gain of the wheels' speed loop 5 % larger than asked. */
#define wheel_loop_update wheel_loop_update_as_asked
#include "firmware_iface/reference/wheel_controller.c"
#undef wheel_loop_update
#include "tests/hil/scenario/firmware/wrapped.h"

float wheel_loop_update(wheel_loop* loop, const wheel_gains* gains, const motor_constants* motor,
                        const wheel_loop_input* input) {
  wheel_gains larger = *gains;
  larger.p_V_s_per_rad *= 1.05f;
  return wheel_loop_update_as_asked(loop, &larger, motor, input);
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static omnihil_firmware_api api;
  api = *reference();
  api.name = "P gain 5 % larger";
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
