// The hidden axis: winding, rotor, shaft and output with everything that may be hidden in a record.
//
// Integrator: fixed-step Runge-Kutta 4 for winding and both masses; a rotor that passes zero within a step is
// cut there, and held while friction suffices (friction as a level), or follows bristles (LuGre) whose stiff
// decay is solved exactly beside the Runge-Kutta step. Sample instants are met by interpolation, so they need
// not lie on the grid.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "axis_params.h"
#include "noise.h"

enum {
  I,
  WR,
  TR,
  WO,
  TO,
  Q,
  E_IN,
  E_LOST,
  STATES
};  // current, rotor speed and angle, output's, charge, energies

typedef struct {
  const AxisParams *p;
  double duty, supply_V, ohm, flux, cap_A, notch_duty;  // held within a step
  double winding_K, housing_K, magnet_K;
  double bristle, travel_rad, hub[3];
  double battery_rc_V, charge_As;
  double dir;  // direction the friction works against
  int stuck;
  int contact_open;
  double contact_next_s;
  NoiseSource noise;
} Axis;

static double sign(double x) { return (x > 0) - (x < 0); }
static double clamp(double x, double limit) { return x > limit ? limit : x < -limit ? -limit : x; }
// A smooth max(x, 0): zero far below, x far above, the corner as wide as w.
static double soft_plus(double x, double w) { return 0.5 * (x + sqrt(x * x + w * w)); }

static int two_masses(const AxisParams *p) { return p->play_rad > 0 || p->shaft_Nm_per_rad > 0; }

// Torque constant over angle, heat, saturation: what one ampere gives.
static double flux_of(const Axis *a, const double *y) {
  const AxisParams *p = a->p;
  double flux = a->flux;
  if (p->ripple != 0)
    flux *= 1 + p->ripple * cos(p->ripple_order * y[TR] + p->ripple_phase) +
            p->ripple2 * cos(2 * p->ripple_order * y[TR] + 1.7 * p->ripple_phase);
  if (p->knee_A > 0) {
    const double x = y[I] / p->knee_A;
    flux *= fabs(x) < 1e-6 ? 1 : atan(x) / x;  // flux linkage bends like an arc tangent
  }
  return flux;
}

// Torque per ampere over back-EMF constant where commutation comes early by `advance_rad` when turning
// forwards, and late by it when turning backwards.
static double advance_ratio(const Axis *a, const double *y) {
  const AxisParams *p = a->p;
  // The current of a phase needs the overlap angle to change over: it lags by half of it.
  const double overlap = p->pole_pairs * fabs(y[WR]) * p->inductance_H * fabs(y[I]) /
                         (a->ohm * fabs(y[I]) + fabs(a->flux * y[WR]) + 1e-6 +
                          p->pole_pairs * fabs(y[WR] * y[I]) * p->inductance_H);
  return 1 + tan(p->advance_rad) * sign(y[WR]) * overlap;
}

static double bus_of(const Axis *a, const double *y) {
  return a->supply_V - a->p->battery_ohm * a->duty * y[I] - a->battery_rc_V;
}

// Mean voltage the bridge puts on the winding.
static double bridge_of(const Axis *a, const double *y, double emf) {
  const AxisParams *p = a->p;
  double u = a->duty * bus_of(a, y);
  if (p->coast_band > 0) {  // short pulses never open the bridge: the winding is left alone
    const double x = (fabs(a->duty) - 0.85 * p->coast_band) / (0.3 * p->coast_band);
    const double on = x <= 0 ? 0 : x >= 1 ? 1 : x * x * (3 - 2 * x);
    u = on * u + (1 - on) * emf;
  }
  if (p->edge_V != 0) u -= p->edge_V * tanh(y[I] / p->edge_A);
  if (a->cap_A > 0 && fabs(y[I]) > 0.9 * a->cap_A)
    u -= sign(y[I]) * p->current_cap_ohm * soft_plus(fabs(y[I]) - a->cap_A, 0.01 * a->cap_A);
  return u;
}

static double output_torque(const Axis *a, double angle) {
  const AxisParams *p = a->p;
  double t = p->push_Nm - p->pendulum_Nm * sin(angle);
  if (p->pendulum2_Nm != 0) t -= p->pendulum2_Nm * sin(angle + p->pendulum2_phase);
  if (p->cable_Nm_per_rad != 0) t -= p->cable_Nm_per_rad * angle;
  if (p->seam_Nm != 0) {  // the belt's seam meets the pulley once per belt turn
    const double at = remainder(angle / (2 * M_PI) / p->seam_turns - 0.3, 1.0) / 0.02;
    t -= p->seam_Nm * at * exp(0.5 - 0.5 * at * at);
  }
  return t;
}

static double shaft_torque(const AxisParams *p, const double *y) {  // on the output
  const double twist = y[TR] / p->gear - y[TO], rate = y[WR] / p->gear - y[WO];
  const double half = 0.5 * p->play_rad;
  const double press = twist > half ? twist - half : twist < -half ? twist + half : 0;
  if (p->play_rad > 0 && press == 0) return 0;
  const double t = p->shaft_Nm_per_rad * press + p->shaft_damping_Nms * rate;
  return p->play_rad > 0 && t * press < 0 ? 0 : t;  // flanks push, they do not pull
}

// All on the rotor but dry friction. *motor_Nm is what the winding gives.
static double free_torque(const Axis *a, const double *y, double *motor_Nm) {
  const AxisParams *p = a->p;
  double t = flux_of(a, y) * y[I];
  if (p->advance_rad != 0) t *= cos(p->advance_rad) * advance_ratio(a, y);
  *motor_Nm = t;
  if (p->gear_loss != 0) {
    const double loss = p->gear_loss * (1 + 0.1 * exp(-fabs(t) / 0.05));
    const double drives = 0.5 * (1 + tanh(t * y[WR] / p->gear_edge_W));
    t *= drives * (1 - loss) + (1 - drives) / (1 - loss);
  }
  if (p->cog_Nm != 0)
    t += p->cog_Nm * sin(p->cog_order * y[TR] + p->cog_phase) +
         p->cog2_Nm * sin(p->cog2_order * y[TR] + p->cog2_phase) +
         p->cog3_Nm * sin(p->cog3_order * y[TR] + p->cog3_phase);
  if (p->unbalance_Nm != 0) t -= p->unbalance_Nm * sin(y[TR] + p->unbalance_phase);
  t -= p->viscous_Nms * (1 + p->viscous_direction * sign(y[WR])) * y[WR];
  if (p->drag_Nm != 0) t -= p->drag_Nm * sign(y[WR]) * pow(fabs(y[WR]) / 300, p->drag_power);
  if (p->hub_Nm != 0) t -= p->hub_Nm * (0.5 * a->hub[0] + 0.3 * a->hub[1] + 0.2 * a->hub[2]);
  return two_masses(p) ? t - shaft_torque(p, y) / p->gear : t + output_torque(a, y[TR] / p->gear) / p->gear;
}

static double dry_level(const Axis *a, const double *y, double dir, double motor_Nm) {
  const AxisParams *p = a->p;
  double c = p->dry_Nm * (1 + p->dry_direction * dir);
  if (p->loaded_ratio != 0) {
    const double e = p->loaded_edge_Nm;
    c += p->loaded_ratio * (sqrt(motor_Nm * motor_Nm + e * e) - e);
  }
  if (p->run_in_ratio != 0) c *= 1 + p->run_in_ratio * exp(-a->travel_rad / p->run_in_rad);
  if (p->bump_Nm != 0) {
    const double at = remainder(y[TR] / p->gear - p->bump_angle, 2 * M_PI) / 0.25;
    c += p->bump_Nm * exp(-0.5 * at * at);
  }
  return c;
}

static double bristle_level(const Axis *a, const double *y, double motor_Nm) {
  const double r = y[WR] / a->p->breakaway_rad_s;
  return dry_level(a, y, sign(y[WR]), motor_Nm) + a->p->dry_Nm * a->p->breakaway_ratio * exp(-r * r);
}

static void rates(const Axis *a, const double *y, double *dy) {
  const AxisParams *p = a->p;
  double motor_Nm;
  const double flux = flux_of(a, y) * (p->advance_rad != 0 ? cos(p->advance_rad) : 1);
  const double emf = flux * ((1 - p->back_emf_lost) * y[WR] + p->back_emf_lost);
  const double u = bridge_of(a, y, emf);
  double t = free_torque(a, y, &motor_Nm);
  double dry;
  if (p->bristles > 0) {
    const double g = bristle_level(a, y, motor_Nm) + 1e-9;
    const double z_rate = y[WR] * (1 - p->bristle_Nm_per_rad * sign(y[WR]) * a->bristle / g);
    dry = p->bristle_Nm_per_rad * a->bristle + p->bristle_damping_Nms * exp(-fabs(y[WR]) / 2) * z_rate;
  } else {
    dry = a->dir * dry_level(a, y, a->dir, motor_Nm);
  }
  dy[I] = (u - a->ohm * y[I] - emf) / p->inductance_H;
  if (two_masses(p)) {
    dy[WR] = (t - dry) / p->rotor_kgm2;
    dy[WO] = (shaft_torque(p, y) + output_torque(a, y[TO])) / p->load_kgm2;
    dy[TO] = y[WO];
  } else {
    dy[WR] = (t - dry) / (p->rotor_kgm2 + p->load_kgm2 / (p->gear * p->gear));
    dy[WO] = dy[TO] = 0;
  }
  dy[TR] = y[WR];
  if (a->stuck) dy[WR] = 0;
  dy[Q] = y[I];
  dy[E_IN] = u * y[I];
  dy[E_LOST] = a->ohm * y[I] * y[I] + dry * y[WR] + p->viscous_Nms * y[WR] * y[WR];
}

static void runge_kutta(const Axis *a, double *y, double h) {
  double k1[STATES], k2[STATES], k3[STATES], k4[STATES], m[STATES];
  rates(a, y, k1);
  for (int j = 0; j < STATES; j++) m[j] = y[j] + 0.5 * h * k1[j];
  rates(a, m, k2);
  for (int j = 0; j < STATES; j++) m[j] = y[j] + 0.5 * h * k2[j];
  rates(a, m, k3);
  for (int j = 0; j < STATES; j++) m[j] = y[j] + h * k3[j];
  rates(a, m, k4);
  for (int j = 0; j < STATES; j++) y[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
}

// Standing still: does friction hold? Otherwise it works against the way the rotor is about to go.
static void settle(Axis *a, double *y) {
  double motor_Nm;
  y[WR] = 0;
  const double t = free_torque(a, y, &motor_Nm), dir = t >= 0 ? 1 : -1;
  a->stuck = fabs(t) <= dry_level(a, y, dir, motor_Nm);
  a->dir = a->stuck ? 0 : dir;
}

static void step_with_level(Axis *a, double *y, double h) {
  if (a->stuck) settle(a, y);
  if (a->stuck) {
    runge_kutta(a, y, h);
    return;
  }
  double before[STATES];
  memcpy(before, y, sizeof before);
  runge_kutta(a, y, h);
  if (y[WR] * a->dir >= 0) return;
  const double w0 = before[WR] * a->dir, w1 = y[WR] * a->dir, part = w0 > 0 ? w0 / (w0 - w1) : 0;
  memcpy(y, before, sizeof before);
  if (part > 0) runge_kutta(a, y, part * h);
  settle(a, y);
  runge_kutta(a, y, (1 - part) * h);
  if (y[WR] * a->dir < 0) settle(a, y);
}

// z' = w - s |w| z / g with w held: z goes to the level exponentially, exactly.
static void bend_bristles(Axis *a, const double *y, double h) {
  double motor_Nm;
  free_torque(a, y, &motor_Nm);
  const double s = a->p->bristle_Nm_per_rad, end = sign(y[WR]) * (bristle_level(a, y, motor_Nm) + 1e-9) / s;
  if (y[WR] != 0) a->bristle = end + (a->bristle - end) * exp(-fabs(y[WR] / end) * h);
}

static void slow_states(Axis *a, const double *y, double h) {
  const AxisParams *p = a->p;
  const double heat_W = a->ohm * y[I] * y[I], flow_W = (a->winding_K - a->housing_K) / p->winding_K_per_W;
  a->winding_K += h * (heat_W - flow_W) / p->winding_J_per_K;
  a->housing_K += h * (flow_W - a->housing_K / p->housing_K_per_W) / p->housing_J_per_K;
  a->magnet_K = a->housing_K + p->magnet_share * (a->winding_K - a->housing_K);
  a->battery_rc_V += h * (p->battery_rc_ohm * a->duty * y[I] - a->battery_rc_V) / p->battery_rc_s;
  a->charge_As += h * a->duty * y[I];
  a->travel_rad += h * fabs(y[WR]);
  if (p->hub_Nm != 0)
    for (int j = 0; j < 3; j++) {  // Masing's elements: springs that slip, each at its own travel
      const double reach = p->hub_rad * (j == 0 ? 0.3 : j == 1 ? 2.0 : 12.0);
      a->hub[j] = clamp(a->hub[j] + h * y[WR] / reach, 1);
    }
}

static void hold_for_step(Axis *a, double t) {  // what changes slower than a step
  const AxisParams *p = a->p;
  a->supply_V = p->supply_V + p->supply_drift_V * sin(2 * M_PI * p->supply_drift_Hz * t + 1) -
                p->battery_fall_V_per_As * a->charge_As;
  if (p->hum_V != 0) a->supply_V += p->hum_V * sin(2 * M_PI * p->hum_Hz * t);
  if (p->contact_ohm > 0 && t >= a->contact_next_s) {
    a->contact_open = !a->contact_open;
    a->contact_next_s = t - p->contact_s * log(uniform(&a->noise));
  }
  a->ohm = p->resistance_ohm * (1 + p->copper_per_K * a->winding_K) + (a->contact_open ? p->contact_ohm : 0);
  a->flux = p->flux_Vs * (1 - p->magnet_per_K * a->magnet_K);
  a->cap_A = p->current_cap_A;
  if (p->derating_A_per_K > 0 && a->winding_K > p->derating_from_K) {  // no limit while it is cold
    const double cap =
        p->derating_full_A - p->derating_A_per_K * soft_plus(a->winding_K - p->derating_from_K, 1);
    a->cap_A = cap > 0.05 * p->derating_full_A ? cap : 0.05 * p->derating_full_A;
  }
}

static double firmware_duty(const AxisParams *p, double duty) {
  duty = clamp(duty, p->duty_cap < 1 ? p->duty_cap : 1);
  return p->duty_steps > 0 ? round(duty * p->duty_steps) / p->duty_steps : duty;
}

// Mean over [t, t + h] of rows that hold from their instant on, the whole late by late_command_s.
static double late_mean(const AxisParams *p, const double *rows, int n, int upto, double t, double h) {
  const double from = (t - p->late_command_s) / p->sample_s, to = from + h / p->sample_s;
  const int j = (int)floor(from + 1e-9), k = (int)floor(to - 1e-9);
  const int last = upto < n - 1 ? upto : n - 1;
  const double first = j < 0 ? 0 : rows[j > last ? last : j], second = k < 0 ? 0 : rows[k > last ? last : k];
  return j == k ? first : first + (second - first) * (to - k) / (to - from);
}

typedef struct {  // a speed loop or a position servo, as firmware runs it
  double target, integral, angle[6], notch_x[2], notch_y[2], smooth, ramp;
} Firmware;

enum { TURNS_PER_ROW = 4 };  // of the firmware's loop

// What firmware does to a duty in a turn of its loop: exponential smoothing, then steps of a largest size. Both begin at zero.
static double soften(Firmware *f, const AxisParams *p, double duty) {
  const double turn_s = p->sample_s / TURNS_PER_ROW;
  if (p->smooth_s > 0) duty = f->smooth += (1 - exp(-turn_s / p->smooth_s)) * (duty - f->smooth);
  if (p->most_duty_per_s > 0) duty = f->ramp += clamp(duty - f->ramp, p->most_duty_per_s * turn_s);
  return duty;
}

static double speed_loop(Firmware *f, const AxisParams *p, double target, double angle) {
  const double count = 2 * M_PI / p->encoder_cpr;
  memmove(f->angle + 1, f->angle, 5 * sizeof(double));
  f->angle[0] = floor(angle / count) * count;
  const double error = target - (f->angle[0] - f->angle[5]) / (5 * p->sample_s);
  const double asked = p->loop_kp * error + f->integral;
  if (fabs(asked) < 0.95) f->integral += p->loop_ki * error * p->sample_s;
  return clamp(asked, 0.95);
}

// Second-order notch, bilinear (Oppenheim, Schafer 2010, sec. 7.1).
static double notch(Firmware *f, const AxisParams *p, double x) {
  const double w = tan(M_PI * p->notch_Hz * p->sample_s), d = 1 + w * p->notch_width + w * w;
  const double y = ((1 + w * w) * (x + f->notch_x[1]) + 2 * (w * w - 1) * (f->notch_x[0] - f->notch_y[0]) -
                    (1 - w * p->notch_width + w * w) * f->notch_y[1]) /
                   d;
  f->notch_x[1] = f->notch_x[0];
  f->notch_x[0] = x;
  f->notch_y[1] = f->notch_y[0];
  f->notch_y[0] = y;
  return y;
}

static void fill_row(const Axis *a, const double *y, const double *before, double part, double *row,
                     double *last_q, double since_s) {
  const AxisParams *p = a->p;
  double s[STATES];
  for (int j = 0; j < STATES; j++) s[j] = before[j] + part * (y[j] - before[j]);
  row[RAW_BUS] = bus_of(a, s);
  row[RAW_CURRENT] = since_s > 0 ? (s[Q] - *last_q) / since_s : s[I];
  row[RAW_ANGLE] = s[TR];
  row[RAW_SPEED] = s[WR];
  row[RAW_OUT_ANGLE] = two_masses(p) ? s[TO] : s[TR] / p->gear;
  row[RAW_OUT_SPEED] = two_masses(p) ? s[WO] : s[WR] / p->gear;
  row[RAW_WINDING_K] = a->winding_K;
  *last_q = s[Q];
}

// Runs n samples. `asked`: one row per sample (duty, position or speed target). `raw`: n x RAW_COLUMNS.
// `sums`: SUM_COLUMNS. Returns 0, or 1 when the state stopped being finite.
int axis_run(const AxisParams *p, const double *asked, int n, double *raw, double *sums) {
  Axis a = {.p = p, .stuck = 1, .noise = {(unsigned long long)p->seed * 7919 + 13}};
  Firmware f = {0};
  double y[STATES] = {0}, before[STATES], t = 0, last_q = 0, last_s = 0;
  double *duty = calloc((size_t)n, sizeof(double)), *stamp = calloc((size_t)n, sizeof(double));
  a.contact_next_s = p->contact_s;
  for (int k = 0; k < n; k++)
    stamp[k] = k * p->sample_s - p->late_sample_s +
               clamp(p->sample_jitter_s > 0 ? p->sample_jitter_s * gauss(&a.noise) : 0, 0.49 * p->sample_s);
  const int substeps = (int)lround(p->sample_s / p->step_s);
  const int softens = p->smooth_s > 0 || p->most_duty_per_s > 0;
  double softened = 0;
  int next = 0;
  hold_for_step(&a, 0);
  for (; next < n && stamp[next] <= 0; next++) fill_row(&a, y, y, 0, raw + next * RAW_COLUMNS, &last_q, 0);
  for (int k = 0; k < n; k++) {
    duty[k] = asked[k];
    if (p->command_kind == 2) duty[k] = speed_loop(&f, p, asked[k], y[TR]);
    if (p->command_kind == 1) {
      const double way = asked[k] - f.target, most = p->target_rate_rad_s * p->sample_s;
      f.target += p->target_rate_rad_s > 0 ? clamp(way, most) : way;
      duty[k] = f.target;
    }
    raw[k * RAW_COLUMNS + RAW_COMMAND] = p->command_kind == 1 ? asked[k] : duty[k];
    if (p->notch_Hz > 0) duty[k] = notch(&f, p, duty[k]);
    for (int j = 0; j < substeps; j++) {
      const double h = p->step_s;
      hold_for_step(&a, t);
      double ask = late_mean(p, duty, n, k, t, h);
      if (p->command_kind == 1)
        ask = clamp(p->servo_duty_per_rad * (ask - (two_masses(p) ? y[TO] : y[TR] / p->gear)),
                    p->servo_duty_limit);
      if (softens && j % (substeps / TURNS_PER_ROW) == 0) softened = soften(&f, p, ask);
      a.duty = firmware_duty(p, softens ? softened : ask);
      memcpy(before, y, sizeof y);
      if (p->bristles > 0) {
        a.stuck = 0;
        bend_bristles(&a, y, 0.5 * h);
        runge_kutta(&a, y, h);
        bend_bristles(&a, y, 0.5 * h);
      } else {
        step_with_level(&a, y, h);
      }
      slow_states(&a, y, h);
      t = k * p->sample_s + (j + 1) * h;
      for (; next < n && stamp[next] <= t + 1e-12; next++) {
        const double part = 1 - (t - stamp[next]) / h;
        fill_row(&a, y, before, part, raw + next * RAW_COLUMNS, &last_q, stamp[next] - last_s);
        last_s = stamp[next];
      }
    }
    if (!isfinite(y[WR] + y[I])) break;
  }
  free(duty);
  free(stamp);
  sums[SUM_IN_J] = y[E_IN];
  sums[SUM_LOST_J] = y[E_LOST];
  const double j_kgm2 = p->rotor_kgm2 + (two_masses(p) ? 0 : p->load_kgm2 / (p->gear * p->gear));
  sums[SUM_STORED_J] = 0.5 * (j_kgm2 * y[WR] * y[WR] + p->inductance_H * y[I] * y[I] +
                              (two_masses(p) ? p->load_kgm2 * y[WO] * y[WO] : 0));
  return isfinite(y[WR] + y[I]) ? 0 : 1;
}

// The same axis row by row, for a bench that lives: it is asked as commands come. No delays of record (late_command_s,
// late_sample_s, jitter), no notch.
typedef struct {
  AxisParams p;
  Axis a;
  double y[STATES], last_q;
  long row;
} LiveAxis;

enum { LIVE_OFF, LIVE_DUTY, LIVE_VOLTAGE, LIVE_CURRENT };

void *axis_open(const AxisParams *p) {
  LiveAxis *l = calloc(1, sizeof *l);
  l->p = *p;
  l->a = (Axis){.p = &l->p, .stuck = 1, .noise = {(unsigned long long)p->seed * 7919 + 13}};
  l->a.contact_next_s = p->contact_s;
  hold_for_step(&l->a, 0);
  return l;
}

void axis_close(void *live) { free(live); }

// Duty of a step. Off: the winding sees its own back-EMF. Current: a loop of 1 kHz on the true winding, as fast as drives have.
static double live_duty(LiveAxis *l, int how, double asked) {
  Axis *a = &l->a;
  const double emf = a->flux * l->y[WR], bus = bus_of(a, l->y);
  switch (how) {
    case LIVE_DUTY:
      return firmware_duty(&l->p, asked);
    case LIVE_VOLTAGE:
      return clamp(asked / bus, 1);
    case LIVE_CURRENT:
      return clamp(
          (l->p.resistance_ohm * asked + emf + 2 * M_PI * 1000 * l->p.inductance_H * (asked - l->y[I])) / bus,
          1);
    default:
      l->y[I] = 0;
      return clamp(emf / bus, 1);
  }
}

// One row of sample_s: `out` is RAW_COLUMNS at its beginning.
int axis_row(void *live, int how, double asked, double *out) {
  LiveAxis *l = live;
  Axis *a = &l->a;
  double *y = l->y, before[STATES];
  const double h = l->p.step_s;
  const int substeps = (int)lround(l->p.sample_s / h);
  fill_row(a, y, y, 0, out, &l->last_q, l->row > 0 ? l->p.sample_s : 0);
  out[RAW_COMMAND] = asked;
  for (int j = 0; j < substeps; j++) {
    hold_for_step(a, l->row * l->p.sample_s + j * h);
    a->duty = live_duty(l, how, asked);
    memcpy(before, y, sizeof before);
    if (l->p.bristles > 0) {
      a->stuck = 0;
      bend_bristles(a, y, 0.5 * h);
      runge_kutta(a, y, h);
      bend_bristles(a, y, 0.5 * h);
    } else {
      step_with_level(a, y, h);
    }
    slow_states(a, y, h);
  }
  l->row++;
  return !isfinite(y[WR] + y[I]);
}

// RAW_COLUMNS now, before it goes on: the current is the mean of the row behind it.
void axis_look(const void *live, double *out) {
  const LiveAxis *l = live;
  double last_q = l->last_q;
  fill_row(&l->a, l->y, l->y, 0, out, &last_q, l->row > 0 ? l->p.sample_s : 0);
}

static const char *const kNames[] = {
#define X(name, value) #name,
    AXIS_PARAMS(X)
#undef X
};
static const double kValues[] = {
#define X(name, value) value,
    AXIS_PARAMS(X)
#undef X
};

int axis_param_count(void) { return (int)(sizeof kNames / sizeof *kNames); }
const char *axis_param_name(int k) { return kNames[k]; }
double axis_param_value(int k) { return kValues[k]; }
