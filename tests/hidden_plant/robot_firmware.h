// What the hidden robot's board does with radio commands, once per row: the loop of a usual SSL firmware.
//
// Speeds are differences of counts through a first-order low pass; the commanded body velocity is approached at no more
// than an acceleration; each wheel has a PI loop in volts with a feed-forward, whose sum stands still at the limit. Bend and
// kick make it a law that the program has no numbers for.
#pragma once
#include <math.h>

#include "robot_params.h"

typedef struct {
  double goal[3], sum[4], speed[4], count[4];
  int awake;
} Firmware;

static void firmware_tick(Firmware *f, const RobotParams *p, const double *command, const double *counts,
                          double bus, double *duty) {
  const double dt = p->sample_s, angle[4] = {p->angle_1, p->angle_2, p->angle_3, p->angle_4};
  double gap[3];
  for (int a = 0; a < 3; a++) gap[a] = command[a] - f->goal[a];
  const double flat = hypot(gap[0], gap[1]), most = p->loop_accel_m_s2 * dt, turn = p->loop_alpha_rad_s2 * dt;
  const double part = flat > most ? most / flat : 1;
  f->goal[0] += part * gap[0];
  f->goal[1] += part * gap[1];
  f->goal[2] += fmin(turn, fmax(-turn, gap[2]));
  for (int k = 0; k < 4; k++) {
    const double raw = f->awake ? (counts[k] - f->count[k]) * 2 * M_PI / p->encoder_cpr / dt : 0;
    f->count[k] = counts[k];
    f->speed[k] += dt / (p->loop_filter_s + dt) * (raw - f->speed[k]);
    const double a = angle[k] * M_PI / 180;
    const double rim = -sin(a) * f->goal[0] + cos(a) * f->goal[1] + p->loop_base_m * f->goal[2];
    const double wanted = rim / p->loop_wheel_m * p->gear, error = wanted - f->speed[k];
    double u = p->loop_ff * wanted + p->loop_kp * error + p->loop_ki * f->sum[k];
    // What no plain PI has: a voltage against friction, and a gain that falls with the error.
    if (p->loop_kick_V != 0) u += p->loop_kick_V * tanh(wanted / p->loop_kick_rad_s);
    if (p->loop_bend != 0) u -= p->loop_kp * error * (1 - 1 / (1 + p->loop_bend * fabs(error)));
    if (fabs(u) < bus || u * error < 0) f->sum[k] += error * dt;
    duty[k] = fmax(-1, fmin(1, u / bus));
  }
  f->awake = 1;
}
