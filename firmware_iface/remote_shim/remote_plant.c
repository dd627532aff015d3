#include "remote_plant.h"

#include <string.h>

enum { kHelloBytes = 56, kSensorsBytes = 39, kDriveBytes = 18, kHelloEvery_us = 200000, kDriveDuty = 1 };

void omnihil_remote_plant_init(omnihil_remote_plant* p, const omnihil_remote_robot* robot,
                               uint16_t timeout_periods, omnihil_remote_write write, void* port) {
  memset(p, 0, sizeof *p);
  p->robot = *robot;
  p->timeout_periods = timeout_periods > 0 ? timeout_periods : 1;
  p->write = write;
  p->port = port;
}

static void send(omnihil_remote_plant* p, uint8_t type, uint16_t sequence, const uint8_t* payload,
                 size_t bytes) {
  uint8_t wire[OMNIHIL_REMOTE_WIRE_MAX];
  size_t count = omnihil_remote_encode(type, sequence, payload, bytes, wire);
  if (count > 0) p->write(p->port, wire, count);
}

static void let_go(omnihil_remote_plant* p) {
  memset(p->mode, 0, sizeof p->mode);
  memset(p->duty, 0, sizeof p->duty);
  p->drive_number = 0;
}

static void take_drive(omnihil_remote_plant* p, const omnihil_remote_frame* f) {
  if (f->bytes != kDriveBytes) return;
  for (int i = 0; i < OMNIHIL_REMOTE_WHEELS; ++i)
    if (f->payload[i] > kDriveDuty) return;
  for (int i = 0; i < OMNIHIL_REMOTE_WHEELS; ++i) {
    p->came_mode[i] = f->payload[i];
    p->came_duty[i] = (int16_t)omnihil_get_u16(f->payload + 4 + 2 * i);
  }
  p->came_number = f->sequence;
  p->drive_new = 1;
}

void omnihil_remote_plant_receive(omnihil_remote_plant* p, uint8_t byte) {
  omnihil_remote_frame f;
  if (!omnihil_remote_decode(&p->decoder, byte, &f)) return;
  if (f.type == OMNIHIL_REMOTE_HELLO_ANSWER) {
    p->greeted = 1;
    p->drive_new = 0;
    p->silent_periods = 0;
    let_go(p);
  } else if (f.type == OMNIHIL_REMOTE_DRIVE && p->greeted) {
    take_drive(p, &f);
  }
}

static void send_hello(omnihil_remote_plant* p) {
  const omnihil_remote_robot* r = &p->robot;
  uint8_t b[kHelloBytes];
  memset(b, 0, sizeof b);
  b[0] = OMNIHIL_REMOTE_VERSION;
  b[1] = OMNIHIL_REMOTE_WHEELS;
  omnihil_put_u32(b + 4, r->robot_id);
  for (int i = 0; i < OMNIHIL_REMOTE_WHEELS; ++i) omnihil_put_f32(b + 8 + 4 * i, r->wheel_angle_rad[i]);
  omnihil_put_f32(b + 24, r->wheel_radius_m);
  omnihil_put_f32(b + 28, r->wheel_center_radius_m);
  omnihil_put_f32(b + 32, r->gear_ratio);
  omnihil_put_f32(b + 36, r->encoder_counts_per_rotor_turn);
  omnihil_put_f32(b + 40, r->bus_voltage_nominal_V);
  omnihil_put_f32(b + 44, r->motor_resistance_ohm);
  omnihil_put_f32(b + 48, r->motor_torque_constant_Nm_per_A);
  omnihil_put_f32(b + 52, r->command_timeout_s);
  send(p, OMNIHIL_REMOTE_HELLO, 0, b, sizeof b);
}

static void send_sensors(omnihil_remote_plant* p) {
  const omnihil_remote_sensors* s = &p->sensors;
  uint8_t b[kSensorsBytes];
  omnihil_put_u32(b, s->now_us);
  for (int i = 0; i < OMNIHIL_REMOTE_WHEELS; ++i) {
    omnihil_put_u32(b + 4 + 4 * i, (uint32_t)s->encoder_counts[i]);
    omnihil_put_u16(b + 20 + 2 * i, (uint16_t)s->motor_current_mA[i]);
  }
  omnihil_put_u16(b + 28, s->bus_voltage_mV);
  omnihil_put_u16(b + 30, (uint16_t)s->gyro_z_mrad_s);
  omnihil_put_u16(b + 32, (uint16_t)s->accel_x_mm_s2);
  omnihil_put_u16(b + 34, (uint16_t)s->accel_y_mm_s2);
  b[36] = s->ball_seen;
  omnihil_put_u16(b + 37, p->drive_number);
  send(p, OMNIHIL_REMOTE_SENSORS, p->number, b, sizeof b);
}

void omnihil_remote_plant_tick(omnihil_remote_plant* p) {
  if (!p->greeted) {
    if (!p->said_hello || (int32_t)(p->sensors.now_us - p->next_hello_us) >= 0) {
      send_hello(p);
      p->said_hello = 1;
      p->next_hello_us = p->sensors.now_us + kHelloEvery_us;
    }
    return;
  }
  if (p->drive_new) {
    p->drive_new = 0;
    p->silent_periods = 0;
    memcpy(p->mode, p->came_mode, sizeof p->mode);
    memcpy(p->duty, p->came_duty, sizeof p->duty);
    p->drive_number = p->came_number;
  } else if (p->silent_periods < UINT16_MAX && ++p->silent_periods >= p->timeout_periods) {
    let_go(p);
    p->greeted = 0; /* whoever comes next is told what hangs here */
    p->said_hello = 0;
    return;
  }
  if (++p->number == 0) p->number = 1; /* 0 is no number */
  send_sensors(p);
}

int omnihil_remote_plant_drives(const omnihil_remote_plant* p, int wheel) {
  return p->mode[wheel] == kDriveDuty;
}

float omnihil_remote_plant_duty(const omnihil_remote_plant* p, int wheel) {
  const float duty = (float)p->duty[wheel] / 32767.0f;
  return duty < -1.0f ? -1.0f : duty;
}
