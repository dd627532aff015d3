#include "remote_shim.h"

#include <string.h>

enum {
  kHelloBytes = 56,
  kSensorsBytes = 37,
  kPlantSensorsBytes = 39, /* of a board with motors: and the number of the drive in force */
  kCommandBytes = 68,
  kDriveBytes = 18,
  kNameMax = 64,
  kDriveDuty = 1,
  kDriveCoast = 0
};

void omnihil_remote_init(omnihil_remote* r, const char* name, const char* radio_format,
                         uint16_t control_period_us, omnihil_remote_write write, void* port) {
  memset(r, 0, sizeof *r);
  r->name = name;
  r->radio_format = radio_format;
  r->control_period_us = control_period_us;
  r->write = write;
  r->port = port;
}

static void send(omnihil_remote* r, uint8_t type, uint16_t sequence, const uint8_t* payload, size_t bytes) {
  uint8_t wire[OMNIHIL_REMOTE_WIRE_MAX];
  size_t count = omnihil_remote_encode(type, sequence, payload, bytes, wire);
  if (count > 0) r->write(r->port, wire, count);
}

static size_t put_text(uint8_t* at, const char* text) {
  size_t n = 0;
  while (text[n] != 0 && n < kNameMax - 1u) {
    at[n] = (uint8_t)text[n];
    ++n;
  }
  at[n++] = 0;
  return n;
}

static void take_hello(omnihil_remote* r, const omnihil_remote_frame* f) {
  const uint8_t* p = f->payload;
  omnihil_remote_robot* robot = &r->robot;
  uint8_t answer[4 + 2 * kNameMax];
  if (f->bytes != kHelloBytes || p[0] != OMNIHIL_REMOTE_VERSION || p[1] != OMNIHIL_REMOTE_WHEELS) return;
  robot->robot_id = omnihil_get_u32(p + 4);
  for (int i = 0; i < OMNIHIL_REMOTE_WHEELS; ++i) robot->wheel_angle_rad[i] = omnihil_get_f32(p + 8 + 4 * i);
  robot->wheel_radius_m = omnihil_get_f32(p + 24);
  robot->wheel_center_radius_m = omnihil_get_f32(p + 28);
  robot->gear_ratio = omnihil_get_f32(p + 32);
  robot->encoder_counts_per_rotor_turn = omnihil_get_f32(p + 36);
  robot->bus_voltage_nominal_V = omnihil_get_f32(p + 40);
  robot->motor_resistance_ohm = omnihil_get_f32(p + 44);
  robot->motor_torque_constant_Nm_per_A = omnihil_get_f32(p + 48);
  robot->command_timeout_s = omnihil_get_f32(p + 52);
  r->configured = 1;
  r->sensors_new = r->command_new = 0;
  memset(r->mode, kDriveCoast, sizeof r->mode);
  answer[0] = OMNIHIL_REMOTE_VERSION;
  answer[1] = OMNIHIL_REMOTE_WHEELS;
  omnihil_put_u16(answer + 2, r->control_period_us);
  size_t n = 4;
  n += put_text(answer + n, r->name);
  n += put_text(answer + n, r->radio_format);
  send(r, OMNIHIL_REMOTE_HELLO_ANSWER, f->sequence, answer, n);
}

static void take_sensors(omnihil_remote* r, const omnihil_remote_frame* f) {
  const uint8_t* p = f->payload;
  omnihil_remote_sensors* s = &r->sensors;
  if (f->bytes != kSensorsBytes && f->bytes != kPlantSensorsBytes) return;
  s->now_us = omnihil_get_u32(p);
  for (int i = 0; i < OMNIHIL_REMOTE_WHEELS; ++i) {
    s->encoder_counts[i] = (int32_t)omnihil_get_u32(p + 4 + 4 * i);
    s->motor_current_mA[i] = (int16_t)omnihil_get_u16(p + 20 + 2 * i);
  }
  s->bus_voltage_mV = omnihil_get_u16(p + 28);
  s->gyro_z_mrad_s = (int16_t)omnihil_get_u16(p + 30);
  s->accel_x_mm_s2 = (int16_t)omnihil_get_u16(p + 32);
  s->accel_y_mm_s2 = (int16_t)omnihil_get_u16(p + 34);
  s->ball_seen = p[36];
  s->drive_number = f->bytes == kPlantSensorsBytes ? omnihil_get_u16(p + kSensorsBytes) : 0;
  if (r->sensors_new) ++r->skipped_ticks;
  r->sequence = f->sequence;
  r->sensors_new = 1;
}

static void take_command(omnihil_remote* r, const omnihil_remote_frame* f) {
  const uint8_t* p = f->payload;
  omnihil_remote_command* c = &r->command;
  if (f->bytes != kCommandBytes) return;
  c->mode = p[0];
  c->flags = p[1];
  c->kick = p[2];
  c->kick_when = p[3];
  c->v_forward_m_s = omnihil_get_f32(p + 4);
  c->v_left_m_s = omnihil_get_f32(p + 8);
  c->omega_body_rad_s = omnihil_get_f32(p + 12);
  for (int i = 0; i < OMNIHIL_REMOTE_WHEELS; ++i) {
    c->omega_wheel_rad_s[i] = omnihil_get_f32(p + 16 + 4 * i);
    c->duty_ratio[i] = omnihil_get_f32(p + 32 + 4 * i);
  }
  c->yaw_target_rad = omnihil_get_f32(p + 48);
  c->camera_yaw_rad = omnihil_get_f32(p + 52);
  c->v_kick_m_s = omnihil_get_f32(p + 56);
  c->kick_pulse_s = omnihil_get_f32(p + 60);
  c->dribbler_ratio = omnihil_get_f32(p + 64);
  r->command_new = 1;
}

void omnihil_remote_receive(omnihil_remote* r, uint8_t byte) {
  omnihil_remote_frame f;
  if (!omnihil_remote_decode(&r->decoder, byte, &f)) return;
  switch (f.type) {
    case OMNIHIL_REMOTE_HELLO:
      take_hello(r, &f);
      break;
    case OMNIHIL_REMOTE_SENSORS:
      take_sensors(r, &f);
      break;
    case OMNIHIL_REMOTE_COMMAND:
      take_command(r, &f);
      break;
    case OMNIHIL_REMOTE_RADIO:
      if (r->radio_count > 0) ++r->lost_radio;
      memcpy(r->radio, f.payload, f.bytes);
      r->radio_count = f.bytes;
      break;
    default:
      break;
  }
}

int omnihil_remote_tick(omnihil_remote* r) {
  if (!r->configured || !r->sensors_new) return 0;
  r->sensors_new = 0;
  return 1;
}

int32_t omnihil_remote_encoder(const omnihil_remote* r, int wheel) {
  return r->sensors.encoder_counts[wheel];
}

int omnihil_remote_take_command(omnihil_remote* r, omnihil_remote_command* command) {
  if (!r->command_new) return 0;
  *command = r->command;
  r->command_new = 0;
  return 1;
}

size_t omnihil_remote_radio_read(omnihil_remote* r, uint8_t* bytes, size_t capacity) {
  size_t n = r->radio_count < capacity ? r->radio_count : 0;
  memcpy(bytes, r->radio, n);
  r->radio_count = 0;
  return n;
}

void omnihil_remote_radio_write(omnihil_remote* r, const uint8_t* bytes, size_t count) {
  send(r, OMNIHIL_REMOTE_RADIO_OUT, r->sequence, bytes, count);
}

/* Not a number gives 0: a comparison with it is never true. */
static float held(float value, float low, float high) {
  return value >= high ? high : value > low ? value : value <= low ? low : 0.0f;
}

void omnihil_remote_set_duty(omnihil_remote* r, int wheel, float duty_ratio) {
  r->mode[wheel] = kDriveDuty;
  r->duty[wheel] = (int16_t)(held(duty_ratio, -1.0f, 1.0f) * 32767.0f);
}

void omnihil_remote_coast(omnihil_remote* r, int wheel) {
  r->mode[wheel] = kDriveCoast;
  r->duty[wheel] = 0;
}

void omnihil_remote_set_dribbler(omnihil_remote* r, float ratio) {
  r->dribbler = (uint8_t)(held(ratio, 0.0f, 1.0f) * 255.0f);
}

void omnihil_remote_set_charge(omnihil_remote* r, int on) {
  r->flags = (uint8_t)((r->flags & ~1u) | (on ? 1u : 0u));
}

void omnihil_remote_kick(omnihil_remote* r, uint8_t kick, uint16_t pulse_us) {
  r->flags = (uint8_t)((r->flags & 1u) | (kick & 3u) << 1);
  r->kick_pulse_us = pulse_us;
}

void omnihil_remote_done(omnihil_remote* r, uint16_t took_us) {
  uint8_t p[kDriveBytes];
  for (int i = 0; i < OMNIHIL_REMOTE_WHEELS; ++i) {
    p[i] = r->mode[i];
    omnihil_put_u16(p + 4 + 2 * i, (uint16_t)r->duty[i]);
  }
  p[12] = r->flags;
  p[13] = r->dribbler;
  omnihil_put_u16(p + 14, r->kick_pulse_us);
  omnihil_put_u16(p + 16, took_us);
  send(r, OMNIHIL_REMOTE_DRIVE, r->sequence, p, sizeof p);
  r->flags &= 1u; /* a kick is for one frame */
  r->kick_pulse_us = 0;
}
