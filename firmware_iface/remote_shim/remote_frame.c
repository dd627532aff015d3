#include "remote_frame.h"

#include <string.h>

uint16_t omnihil_remote_crc16(const uint8_t* bytes, size_t count) {
  uint32_t crc = 0xFFFFu;
  for (size_t i = 0; i < count; ++i) {
    crc ^= (uint32_t)bytes[i] << 8;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 0x8000u) ? ((crc << 1) ^ 0x1021u) & 0xFFFFu : (crc << 1) & 0xFFFFu;
    }
  }
  return (uint16_t)crc;
}

size_t omnihil_remote_encode(uint8_t type, uint16_t sequence, const uint8_t* payload, size_t bytes,
                             uint8_t* wire) {
  uint8_t body[OMNIHIL_REMOTE_BODY_MAX];
  if (bytes > OMNIHIL_REMOTE_PAYLOAD_MAX) return 0;
  body[0] = type;
  omnihil_put_u16(body + 1, sequence);
  if (bytes > 0) memcpy(body + 3, payload, bytes);
  omnihil_put_u16(body + 3 + bytes, omnihil_remote_crc16(body, 3 + bytes));
  size_t code_at = 0, out = 1;
  uint8_t code = 1;
  for (size_t i = 0; i < bytes + 5; ++i) { /* at most 245: one block never fills up */
    if (body[i] != 0) {
      wire[out++] = body[i];
      ++code;
    } else {
      wire[code_at] = code;
      code_at = out++;
      code = 1;
    }
  }
  wire[code_at] = code;
  wire[out++] = 0;
  return out;
}

/* Takes the stuffing out of the decoder's bytes in place; the bytes left, 0 if they are no COBS. */
static size_t unstuff(uint8_t* bytes, size_t count) {
  size_t in = 0, out = 0;
  while (in < count) {
    uint8_t code = bytes[in++];
    if (in + code - 1u > count) return 0;
    for (uint8_t i = 1; i < code; ++i) bytes[out++] = bytes[in++];
    if (in < count) bytes[out++] = 0;
  }
  return out;
}

int omnihil_remote_decode(omnihil_remote_decoder* d, uint8_t byte, omnihil_remote_frame* frame) {
  if (byte != 0) {
    if (d->count < sizeof d->body) {
      d->body[d->count++] = byte;
    } else {
      d->overflow = 1;
    }
    return 0;
  }
  size_t count = d->count;
  uint8_t overflow = d->overflow;
  d->count = 0;
  d->overflow = 0;
  if (count == 0) return 0; /* delimiters in a row: a sender that clears the line */
  if (overflow) {
    ++d->too_long;
    return 0;
  }
  count = unstuff(d->body, count);
  if (count == 0) {
    ++d->bad_cobs;
    return 0;
  }
  if (count < 5) {
    ++d->too_short;
    return 0;
  }
  if (omnihil_get_u16(d->body + count - 2) != omnihil_remote_crc16(d->body, count - 2)) {
    ++d->bad_crc;
    return 0;
  }
  ++d->good;
  frame->type = d->body[0];
  frame->sequence = omnihil_get_u16(d->body + 1);
  frame->payload = d->body + 3;
  frame->bytes = count - 5;
  return 1;
}

void omnihil_put_u16(uint8_t* at, uint16_t value) {
  at[0] = (uint8_t)(value & 0xFFu);
  at[1] = (uint8_t)(value >> 8);
}

void omnihil_put_u32(uint8_t* at, uint32_t value) {
  omnihil_put_u16(at, (uint16_t)(value & 0xFFFFu));
  omnihil_put_u16(at + 2, (uint16_t)(value >> 16));
}

void omnihil_put_f32(uint8_t* at, float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  omnihil_put_u32(at, bits);
}

uint16_t omnihil_get_u16(const uint8_t* at) { return (uint16_t)(at[0] | (uint16_t)(at[1] << 8)); }

uint32_t omnihil_get_u32(const uint8_t* at) {
  return omnihil_get_u16(at) | (uint32_t)omnihil_get_u16(at + 2) << 16;
}

float omnihil_get_f32(const uint8_t* at) {
  uint32_t bits = omnihil_get_u32(at);
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}
