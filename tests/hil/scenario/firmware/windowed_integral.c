/* The law of RoboCup ULaval's wheel control as its sources state it (RobotMCU 44cc54f, mnrc.c, ctrl_task.c), in the
 * bench's own process: no emulated chip, no timer, no bridge of a board. What it does there, it does by itself.
 *
 *   u = M1^-1 (M2 w + Kp e + Ki * integral of e over the last second), every 10 ms, e = w_ref - w
 *
 * Its reference model settles in one period (1 + dt lambda = 0), so w_m is w_ref. A command of no speed is duty 0.
 * WHOLE: an integral over all of the past instead. */
#include <math.h>
#include <string.h>

#include "firmware_iface/omnihil_firmware.h"

enum { WINDOW = 100, TICKS = 10 };
static const float kKp = 60.0f, kKi = 25.5f, kPeriod_s = 0.01f, kCountsPerTurn = 20480.0f, kTau = 6.2831853f;
static const float kInvM1[4][4] = {{0.0019200f, -0.000986f, 0.000263f, -0.000818f},
                                   {-0.0012300f, 0.002390f, -0.001100f, 0.000539f},
                                   {-0.0000703f, -0.000501f, 0.001660f, -0.000439f},
                                   {-0.0004900f, 0.000192f, -0.000266f, 0.001710f}};
static const float kM2[4][4] = {{4.5265f, 0.2949f, 1.1064f, 0.3471f},
                                {1.0369f, 2.9667f, 0.8380f, 0.1454f},
                                {0.1446f, 0.2892f, 2.9959f, 0.2894f},
                                {0.7098f, 0.1451f, 0.2896f, 3.3578f}};

typedef struct {
  omnihil_robot_config config;
  omnihil_command command;
  float errors_rad[4][WINDOW], integral_rad[4], duty[4];
  int64_t last[4];
  int at, ticks;
} law;

static int init(void* state, const omnihil_robot_config* config) {
  ((law*)state)->config = *config;
  return 0;
}
static void command(void* state, const omnihil_command* wanted, uint64_t now_us) {
  (void)now_us;
  ((law*)state)->command = *wanted;
}
static int set_gains(void* state, const omnihil_gains* gains) { return state == NULL || gains != NULL; }
static void get_gains(const void* state, omnihil_gains* gains) {
  (void)state;
  memset(gains, 0, sizeof *gains);
}
static void feedback(const void* state, omnihil_feedback* out) {
  (void)state;
  memset(out, 0, sizeof *out);
}

static int moves(const omnihil_command* c) {
  return fabs(c->v_forward_m_s) + fabs(c->v_left_m_s) + fabs(c->omega_body_rad_s) > 1e-3;
}

static double wanted_rad_s(const law* l, int w) {
  double a = l->config.wheel_angle_rad[w];
  return (-l->command.v_forward_m_s * sin(a) + l->command.v_left_m_s * cos(a) +
          l->command.omega_body_rad_s * l->config.wheel_center_radius_m) /
         l->config.wheel_radius_m;
}

static float integral(law* l, int w, float error_rad) {
#ifdef WHOLE
  return l->integral_rad[w] += error_rad;
#else
  l->errors_rad[w][l->at] = error_rad;
  float sum = 0.0f;
  for (int i = 0; i < WINDOW; ++i) sum += l->errors_rad[w][i];
  return sum;
#endif
}

static void control(law* l, const omnihil_sensors* sensors) {
  float omega[4], sum[4];
  const int on = moves(&l->command);
  if (!on) {
    memset(l->errors_rad, 0, sizeof l->errors_rad);
    memset(l->integral_rad, 0, sizeof l->integral_rad);
  }
  l->at = (l->at + 1) % WINDOW;
  for (int w = 0; w < 4; ++w) {
    int64_t count = sensors->encoder_counts[w] / 2; /* their timers count the edges of one line */
    omega[w] = (float)(count - l->last[w]) * kTau / (kPeriod_s * kCountsPerTurn);
    l->last[w] = count;
    float error = (float)wanted_rad_s(l, w) - omega[w];
    sum[w] = on ? kKp * error + kKi * integral(l, w, error * kPeriod_s) : 0.0f;
  }
  for (int w = 0; w < 4; ++w) {
    for (int j = 0; j < 4; ++j) sum[w] += kM2[w][j] * omega[j];
  }
  for (int w = 0; w < 4; ++w) {
    float duty = 0.0f;
    for (int j = 0; j < 4; ++j) duty += kInvM1[w][j] * sum[j];
    l->duty[w] = on ? fmaxf(-1.0f, fminf(1.0f, duty)) : 0.0f;
  }
}

static void tick(void* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  law* l = state;
  if (l->ticks++ % TICKS == 0) control(l, sensors);
  for (int w = 0; w < 4; ++w) {
    drive->mode[w] = OMNIHIL_DRIVE_DUTY;
    drive->duty_ratio[w] = (double)l->duty[w];
  }
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static const omnihil_firmware_api api = {.abi_version = OMNIHIL_FIRMWARE_ABI,
                                           .struct_bytes = sizeof(omnihil_firmware_api),
                                           .name = "integral over the last second",
                                           .control_period_us = 1000,
                                           .state_bytes = sizeof(law),
                                           .init = init,
                                           .command = command,
                                           .set_gains = set_gains,
                                           .get_gains = get_gains,
                                           .tick = tick,
                                           .feedback = feedback};
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
