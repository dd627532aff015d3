// The hidden robot: omni wheels on the floor, four unless `wheels` says two to six.
//
// Written in the field's frame, with momentum of the centre of mass. Time stepping after Moreau: windings and
// forces first, then each wheel's speed with the impulse of dry friction that is at most what friction can
// give; a wheel at rest that friction can hold stays at rest. First order; the step (40 us) is short against
// every time constant.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noise.h"
#include "robot_firmware.h"
#include "robot_params.h"

typedef struct {
  const RobotParams *p;
  double x, y, turn, vx, vy, w;    // centre of mass in the field; body's angle and turning speed
  double rim[6], phi[6], amps[6];  // wheels' turning speed and angle, windings' currents
  double sin_a[6], cos_a[6], radius[6], flux[6];
  double push[6], rub[6], counts[6];
  int wheels, dead[6];
  double load[6], inverse[3][3];  // wheel loads; inverse of the load's equations
  double mass, yaw, keep[2];  // keep: share of a winding's current left after a step, contact closed and open
  double bus, rc_V;
  double ax, ay;  // specific force at the geometric centre, body frame
  double contact_next_s;
  int contact_open;
  NoiseSource noise;
} Robot;

static double sign(double v) { return (v > 0) - (v < 0); }
static double largest(double a, double b) { return a > b ? a : b; }

// What a model file declares a tyre to be, over the load: up to the extremum, down to the asymptote, constant
// beyond.
static double declared(double slip, double extremum, double peak, double asymptote, double rest) {
  const double x = fabs(slip) / extremum, t = (fabs(slip) - extremum) / (asymptote - extremum);
  const double f = x < 1   ? x * (1.5 - 0.5 * x * x) * peak
                   : t < 1 ? peak + (rest - peak) * t * t * (3 - 2 * t)
                           : rest;
  return sign(slip) * f;
}

// Brush model (Pacejka 2012, sec. 3.2): bristles that slide one after another.
static double brush(double x, double peak) {
  const double s = fabs(x) / 2;
  return sign(x) * peak * (s >= 1 ? 1 : s * (3 - 3 * s + s * s));
}

static void prepare(Robot *r) {
  const RobotParams *p = r->p;
  const double angle[6] = {p->angle_1, p->angle_2, p->angle_3, p->angle_4, p->angle_5, p->angle_6};
  const double radius[6] = {p->radius_1, p->radius_2, p->radius_3, p->radius_4, p->radius_5, p->radius_6};
  const double flux[6] = {p->flux_1, p->flux_2, p->flux_3, p->flux_4, p->flux_5, p->flux_6};
  const double push[6] = {p->push_1, p->push_2, p->push_3, p->push_4, 1, 1};
  const double rub[6] = {p->rub_1_Nm, p->rub_2_Nm, p->rub_3_Nm, p->rub_4_Nm, 0, 0};
  const double dead[6] = {p->dead_1, p->dead_2, p->dead_3, p->dead_4, 0, 0};
  double m[3][3] = {{0}};
  r->wheels = (int)p->wheels;
  for (int k = 0; k < r->wheels; k++) {
    const double a = angle[k] * M_PI / 180;
    r->sin_a[k] = sin(a);
    r->cos_a[k] = cos(a);
    r->radius[k] = p->wheel_m * radius[k];
    r->flux[k] = p->flux_Vs * flux[k];
    r->push[k] = push[k], r->rub[k] = rub[k], r->dead[k] = dead[k] != 0;
    const double row[3] = {1, p->base_m * r->cos_a[k], p->base_m * r->sin_a[k]};
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) m[i][j] += row[i] * row[j];
  }
  // Two wheels on one axle hold no moment about it: a caster without load does, as if it stood ahead of them.
  if (r->wheels == 2) {
    const double row[3] = {0, -p->base_m * r->sin_a[0], p->base_m * r->cos_a[0]};
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) m[i][j] += row[i] * row[j];
  }
  const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                     m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                     m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      r->inverse[i][j] = (m[a][c] * m[b][d] - m[a][d] * m[b][c]) / det;
    }
  for (int k = 0; k < 2; k++)
    r->keep[k] = exp(-(p->resistance_ohm + k * p->contact_ohm) / p->inductance_H * p->step_s);
  r->mass = p->mass_kg + p->payload_kg;
  // Given about the geometric centre; the equations need it about the centre of mass, where it is the same
  // mass spread alike.
  r->yaw = p->yaw_kgm2 * r->mass / p->mass_kg;
}

// Loads are a plane over the wheels' places (a stiff body on equal springs) that carries the weight, its
// offset, and the moment of the floor's force about the centre of mass.
static void share_load(Robot *r, double fx, double fy) {
  const RobotParams *p = r->p;
  const double weight = r->mass * 9.80665;
  const double right[3] = {weight, weight * p->offset_x_m - p->height_m * fx,
                           weight * p->offset_y_m - p->height_m * fy};
  double plane[3];
  for (int i = 0; i < 3; i++)
    plane[i] = r->inverse[i][0] * right[0] + r->inverse[i][1] * right[1] + r->inverse[i][2] * right[2];
  for (int k = 0; k < r->wheels; k++)
    r->load[k] = largest(0, plane[0] + p->base_m * (plane[1] * r->cos_a[k] + plane[2] * r->sin_a[k]));
}

static double winding(Robot *r, int k, double duty) {
  const RobotParams *p = r->p;
  const double emf = r->flux[k] * r->rim[k] * p->gear, i = r->amps[k];
  double u = duty * r->bus;
  if (p->edge_V != 0) u -= p->edge_V * tanh(i / p->edge_A);
  if (p->current_cap_A > 0 && fabs(i) > 0.9 * p->current_cap_A) {
    const double over = fabs(i) - p->current_cap_A, wide = 0.01 * p->current_cap_A;
    u -= sign(i) * 8 * 0.5 * (over + sqrt(over * over + wide * wide));
  }
  const int open = r->contact_open && k == 1;
  // L di/dt = u - R i - e with u and e held: exact over the step.
  const double end = (u - emf) / (p->resistance_ohm + (open ? p->contact_ohm : 0)), keep = r->keep[open];
  r->amps[k] = end + (i - end) * keep;
  return 0.5 * (i + r->amps[k]);
}

static double motor_torque(const Robot *r, int k, double amps) {  // at the wheel, dry friction left out
  const RobotParams *p = r->p;
  const double rotor = r->rim[k] * p->gear, theta = r->phi[k] * p->gear;
  double t = r->push[k] * r->flux[k] * amps - p->viscous_Nms * rotor;
  if (p->cog_Nm != 0)
    t +=
        p->cog_Nm * sin(p->cog_order * theta + p->cog_phase) + p->cog2_Nm * sin(2 * p->cog_order * theta + 1);
  if (p->drag_Nm != 0) t -= p->drag_Nm * sign(rotor) * rotor * rotor / 9e4;
  return p->gear * t;
}

static void step(Robot *r, const double *duty, double dribbler, double h) {
  const RobotParams *p = r->p;
  const double c = cos(r->turn), s = sin(r->turn);
  // Speed of the geometric centre in the body's frame: v_O = v_C - w x (C - O).
  const double bx = c * r->vx + s * r->vy + r->w * p->offset_y_m,
               by = -s * r->vx + c * r->vy - r->w * p->offset_x_m;
  double fx = 0, fy = 0, moment = 0, bus_A = 0;
  const double wheel_kgm2 = p->wheel_kgm2 + p->gear * p->gear * p->rotor_kgm2;
  for (int k = 0; k < r->wheels; k++) {
    const double along = -r->sin_a[k] * bx + r->cos_a[k] * by + p->base_m * r->w;
    const double across = r->cos_a[k] * bx + r->sin_a[k] * by;
    const double rim = r->radius[k] * r->rim[k], load = r->load[k];
    const double fast = largest(largest(fabs(along), fabs(rim)), p->slip_floor_m_s);
    double f =
        load * (p->brush > 0
                    ? brush((rim - along) / (p->grip_slip * fast + p->brush_m_s), p->brush_grip)
                    : declared((rim - along) / fast, p->grip_slip, p->grip, p->slide_slip, p->slide_grip));
    if (p->roller_ripple != 0)
      f += load * p->roller_ripple *
           (sin(p->rollers * r->phi[k] + p->roller_phase) + 0.15 * sin(2 * p->rollers * r->phi[k]));
    double g =
        -load * declared(across / largest(fabs(across), p->slip_floor_m_s), 1, p->roller_grip, 2, 0.01);
    g -= load * p->roller_drag * 2 / M_PI * atan(across / 0.01);
    fx += -r->sin_a[k] * f + r->cos_a[k] * g;
    fy += r->cos_a[k] * f + r->sin_a[k] * g;
    moment += p->base_m * f;
    const double amps = winding(r, k, duty[k]), motor = motor_torque(r, k, amps);
    bus_A += duty[k] * amps;
    double dry = p->gear * (p->dry_Nm + p->loaded_ratio * fabs(r->flux[k] * amps)) +
                 p->rolling * load * r->radius[k] + r->rub[k];
    const double free_speed = r->rim[k] + h / wheel_kgm2 * (motor - r->radius[k] * f);
    const double most = h / wheel_kgm2 * dry;
    const double after = fabs(free_speed) <= most ? 0 : free_speed - sign(free_speed) * most;
    r->phi[k] += 0.5 * h * (r->rim[k] + after);
    r->rim[k] = after;
  }
  share_load(r, fx, fy);
  const double v = sqrt(bx * bx + by * by);
  if (p->dribbler_N != 0 && dribbler != 0) {
    const double pull =
        p->dribbler_N * fabs(dribbler) / sqrt(dribbler * dribbler + 400) * tanh(v / 0.02) / (v + 1e-9);
    fx -= pull * bx;
    fy -= pull * by;
  }
  if (p->nap != 0 && v > 1e-6) {  // a carpet that drags more against its pile than with it
    const double against = (c * bx - s * by) * cos(p->nap_towards) + (s * bx + c * by) * sin(p->nap_towards);
    const double pull = p->nap * r->mass * 9.80665 * 0.5 * (1 - against / v) * tanh(v / 0.02) / v;
    fx -= pull * bx;
    fy -= pull * by;
  }
  // What an accelerometer at the geometric centre shows: floor's force over mass, less the turning about the
  // centre of mass.
  const double spin = (moment - p->offset_x_m * fy + p->offset_y_m * fx) / r->yaw;
  r->ax = fx / r->mass + spin * p->offset_y_m + r->w * r->w * p->offset_x_m;
  r->ay = fy / r->mass - spin * p->offset_x_m + r->w * r->w * p->offset_y_m;
  const double slope = 9.80665 * sin(p->tilt_rad);
  const double vx = r->vx + h * ((c * fx - s * fy) / r->mass + slope * cos(p->tilt_towards));
  const double vy = r->vy + h * ((s * fx + c * fy) / r->mass + slope * sin(p->tilt_towards));
  const double w = r->w + h * spin;
  r->x += 0.5 * h * (r->vx + vx);
  r->y += 0.5 * h * (r->vy + vy);
  r->turn += 0.5 * h * (r->w + w);
  r->vx = vx, r->vy = vy, r->w = w;
  r->rc_V += h * (p->battery_rc_ohm * bus_A - r->rc_V) / p->battery_rc_s;
  r->bus = -p->battery_ohm * bus_A - r->rc_V;
}

static void centre_of(const Robot *r, double *pose) {  // pose of the geometric centre
  const double c = cos(r->turn), s = sin(r->turn), ox = r->p->offset_x_m, oy = r->p->offset_y_m;
  pose[0] = r->x - c * ox + s * oy;
  pose[1] = r->y - s * ox - c * oy;
  pose[2] = r->turn;
}

static void write_row(Robot *r, const double *charge, double *row) {
  const RobotParams *p = r->p;
  row[BOT_BUS] = r->bus + p->bus_noise_V * gauss(&r->noise);
  for (int k = 0; k < r->wheels; k++) {
    row[BOT_CURRENT + k] =
        round((charge[k] / p->sample_s + p->current_noise_A * gauss(&r->noise)) / 0.01) * 0.01;
    if (!r->dead[k]) r->counts[k] = floor(r->phi[k] * p->gear * p->encoder_cpr / (2 * M_PI));
    row[BOT_COUNTS + k] = r->counts[k];
  }
  row[BOT_GYRO] = r->w + p->gyro_noise_rad_s * gauss(&r->noise);
  row[BOT_AX] = r->ax + p->accel_noise_m_s2 * gauss(&r->noise);
  row[BOT_AY] = r->ay + p->accel_noise_m_s2 * gauss(&r->noise);
  centre_of(r, row + BOT_X);
}

// Camera frames on rows, stamped at exposure; `late_vision_s` makes what a frame shows older than its stamp.
static void add_camera(Robot *r, int n, double *out) {
  const RobotParams *p = r->p;
  double due = 0.004;
  for (int k = 0; k < n; k++) {
    double *row = out + k * BOT_COLUMNS;
    const int frame = k * p->sample_s >= due;
    if (frame) due += 1 / p->vision_Hz;
    const double back = largest(0, k - p->late_vision_s / p->sample_s);
    const int j = (int)floor(back), next = j < n - 1 ? j + 1 : j;
    for (int c = 0; c < 3; c++) {
      const double a = out[j * BOT_COLUMNS + BOT_X + c], b = out[next * BOT_COLUMNS + BOT_X + c];
      const double sigma = c == 2 ? p->vision_noise_rad : p->vision_noise_m;
      row[BOT_CAM_X + c] = frame ? a + (back - j) * (b - a) + sigma * gauss(&r->noise) : NAN;
    }
  }
}

// Runs n samples. `asked`: n x 7, six duties (or vx, vy, w and nothing) and the dribbler's speed. `out`: n x BOT_COLUMNS. 1 when not
// finite.
// From row `change` on it is the robot of `q` (null: never).
int robot_run_changed(const RobotParams *p, const RobotParams *q, int change, const double *asked, int n,
                      double *out) {
  Robot r = {.p = p, .noise = {(unsigned long long)p->seed * 7919 + 31}};
  prepare(&r);
  share_load(&r, 0, 0);
  const int substeps = (int)lround(p->sample_s / p->step_s);
  double charge[6] = {0};
  r.x = p->offset_x_m, r.y = p->offset_y_m;
  r.contact_next_s = p->contact_s;
  double sag = 0, duty[6] = {0};
  Firmware firmware;
  memset(&firmware, 0, sizeof firmware);
  for (int k = 0; k < n; k++) {
    const double t = k * p->sample_s;
    if (q && k == change) {
      r.p = p = q;
      prepare(&r);
    }
    const double source = p->supply_V + p->supply_drift_V * sin(2 * M_PI * p->supply_drift_Hz * t + 1);
    if (p->contact_ohm > 0 && t >= r.contact_next_s) {
      r.contact_open = !r.contact_open;
      r.contact_next_s = t - p->contact_s * log(uniform(&r.noise));
    }
    r.bus = source + sag;
    write_row(&r, charge, out + k * BOT_COLUMNS);
    if (p->radio) {
      const double none[3] = {0};
      const int heard = (int)floor(k - p->late_radio_s / p->sample_s + 1e-9);
      firmware_tick(&firmware, p, heard < 0 ? none : asked + BOT_ASKED * heard,
                    out + k * BOT_COLUMNS + BOT_COUNTS, r.bus, duty);
      for (int i = 0; i < 4; i++) out[k * BOT_COLUMNS + BOT_SPEED + i] = firmware.speed[i] / p->gear;
    }
    memset(charge, 0, sizeof charge);
    for (int j = 0; j < substeps; j++) {
      const double h = p->step_s, late = (t + (j + 0.5) * h - p->late_command_s) / p->sample_s;
      const int row = late < 0 ? -1 : (int)floor(late + 1e-9);
      const double still[BOT_ASKED] = {0}, *ask = row < 0 ? still : asked + BOT_ASKED * row;
      double before[6];
      memcpy(before, r.amps, sizeof before);
      r.bus = source + sag;
      step(&r, p->radio ? duty : ask, ask[BOT_ASKED - 1], h);
      sag = r.bus;
      for (int i = 0; i < r.wheels; i++) charge[i] += 0.5 * h * (before[i] + r.amps[i]);
    }
    if (!isfinite(r.vx + r.rim[0] + r.amps[0])) return 1;
  }
  add_camera(&r, n, out);
  return 0;
}

int robot_run(const RobotParams *p, const double *asked, int n, double *out) {
  return robot_run_changed(p, 0, 0, asked, n, out);
}

// The same robot row by row, for a bench that lives: it is driven by radio commands as they come.
typedef struct {
  RobotParams p;
  Robot r;
  Firmware firmware;
  double charge[6], duty[6], sag;
} Live;

void *robot_open(const RobotParams *p) {
  Live *l = calloc(1, sizeof *l);
  l->p = *p;
  l->r = (Robot){.p = &l->p, .noise = {(unsigned long long)p->seed * 7919 + 31}};
  prepare(&l->r);
  share_load(&l->r, 0, 0);
  l->r.x = p->offset_x_m, l->r.y = p->offset_y_m;
  return l;
}

// From the next row on it is another robot in the same state.
void robot_change(void *live, const RobotParams *p) {
  Live *l = live;
  l->p = *p;
  prepare(&l->r);
}

void robot_close(void *live) { free(live); }

// One row: `heard` is what the firmware acts on now (m/s, m/s, rad/s, body frame); `out`: BOT_COLUMNS at its beginning, no camera.
int robot_row(void *live, const double *heard, double *out) {
  Live *l = live;
  Robot *r = &l->r;
  const RobotParams *p = &l->p;
  r->bus = p->supply_V + l->sag;
  write_row(r, l->charge, out);
  firmware_tick(&l->firmware, p, heard, out + BOT_COUNTS, r->bus, l->duty);
  for (int i = 0; i < 4; i++) out[BOT_SPEED + i] = l->firmware.speed[i] / p->gear;
  memset(l->charge, 0, sizeof l->charge);
  const int substeps = (int)lround(p->sample_s / p->step_s);
  for (int j = 0; j < substeps; j++) {
    double before[6];
    memcpy(before, r->amps, sizeof before);
    r->bus = p->supply_V + l->sag;
    step(r, l->duty, 0, p->step_s);
    l->sag = r->bus;
    for (int i = 0; i < r->wheels; i++) l->charge[i] += 0.5 * p->step_s * (before[i] + r->amps[i]);
  }
  return !isfinite(r->vx + r->rim[0] + r->amps[0]);
}

static const char *const kNames[] = {
#define X(name, value) #name,
    ROBOT_PARAMS(X)
#undef X
};
static const double kValues[] = {
#define X(name, value) value,
    ROBOT_PARAMS(X)
#undef X
};

int robot_param_count(void) { return (int)(sizeof kNames / sizeof *kNames); }
const char *robot_param_name(int k) { return kNames[k]; }
double robot_param_value(int k) { return kValues[k]; }
