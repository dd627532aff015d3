// The hidden robot's own firmware as a library of the bench's boundary: the law of robot_firmware.h with the numbers of one
// robot, compiled in. OWN_PARAMS: "loop_kp=0.03, …" as C. With OWN_GLOBAL its state is a variable of the library.
#include <string.h>

#include "../../../firmware_iface/omnihil_firmware.h"
#include "../robot_firmware.h"

typedef struct {
  Firmware law;
  RobotParams p;
  double heard[3];
  uint64_t now_us;
} Own;

static RobotParams params(void) {
  RobotParams p = {
#define X(name, value) .name = value,
      ROBOT_PARAMS(X)
#undef X
  };
  OWN_PARAMS;
  return p;
}

#ifdef OWN_GLOBAL
static Own the_only_one;
#define SELF(state) ((void)(state), &the_only_one)
#else
#define SELF(state) ((Own *)(state))
#endif

static int init(void *state, const omnihil_robot_config *config) {
  (void)config;
  SELF(state)->p = params();
  return 0;
}

static void command(void *state, const omnihil_command *c, uint64_t now_us) {
  Own *own = SELF(state);
  (void)now_us;
  own->heard[0] = c->v_forward_m_s, own->heard[1] = c->v_left_m_s, own->heard[2] = c->omega_body_rad_s;
}

static int set_gains(void *state, const omnihil_gains *gains) { return (void)state, (void)gains, 1; }
static void get_gains(const void *state, omnihil_gains *gains) {
  (void)state, memset(gains, 0, sizeof *gains);
}

static void tick(void *state, const omnihil_sensors *s, omnihil_drive *drive) {
  Own *own = SELF(state);
  double counts[4];
  for (int i = 0; i < 4; i++) counts[i] = (double)s->encoder_counts[i], drive->mode[i] = OMNIHIL_DRIVE_DUTY;
  firmware_tick(&own->law, &own->p, own->heard, counts, s->bus_voltage_V, drive->duty_ratio);
  own->now_us = s->now_us;
}

static void feedback(const void *state, omnihil_feedback *f) {
  const Own *own = SELF((void *)state);
  memset(f, 0, sizeof *f);
  f->now_us = own->now_us;
  for (int i = 0; i < 4; i++) f->omega_wheel_rad_s[i] = own->law.speed[i] / own->p.gear;
}

static const omnihil_firmware_api kApi = {
    .abi_version = OMNIHIL_FIRMWARE_ABI,
    .struct_bytes = sizeof(omnihil_firmware_api),
    .name = "a robot's own",
    .control_period_us = 1000,
    .state_bytes = sizeof(Own),
    .init = init,
    .command = command,
    .set_gains = set_gains,
    .get_gains = get_gains,
    .tick = tick,
    .feedback = feedback,
};

const omnihil_firmware_api *omnihil_firmware_get(uint32_t version) {
  return version == OMNIHIL_FIRMWARE_ABI ? &kApi : NULL;
}
