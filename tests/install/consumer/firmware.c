/* omnihil::firmware_iface: a firmware that leaves its motors alone, from the C header and nothing else. */
#include <string.h>

#include "omnihil_firmware.h"

static int init(void* state, const omnihil_robot_config* config) { return (void)state, (void)config, 0; }
static void command(void* state, const omnihil_command* c, uint64_t now_us) {
  (void)state, (void)c, (void)now_us;
}
static void receive(void* state, const uint8_t* bytes, size_t count, uint64_t now_us) {
  (void)state, (void)bytes, (void)count, (void)now_us;
}
static size_t transmit(void* state, uint8_t* bytes, size_t capacity) {
  return (void)state, (void)bytes, (void)capacity, 0;
}
static int set_gains(void* state, const omnihil_gains* gains) { return (void)state, (void)gains, 1; }
static void get_gains(const void* state, omnihil_gains* gains) {
  (void)state, memset(gains, 0, sizeof *gains);
}
static void tick(void* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  (void)state, (void)sensors, memset(drive, 0, sizeof *drive); /* OMNIHIL_DRIVE_COAST */
}
static void feedback(const void* state, omnihil_feedback* f) { (void)state, memset(f, 0, sizeof *f); }

static const omnihil_firmware_api kApi = {OMNIHIL_FIRMWARE_ABI,
                                          sizeof(omnihil_firmware_api),
                                          "coasts",
                                          NULL,
                                          1000,
                                          16,
                                          init,
                                          command,
                                          receive,
                                          transmit,
                                          set_gains,
                                          get_gains,
                                          tick,
                                          feedback,
                                          NULL,
                                          NULL};

const omnihil_firmware_api* omnihil_firmware_get(uint32_t abi_version) {
  return abi_version == OMNIHIL_FIRMWARE_ABI ? &kApi : NULL;
}
