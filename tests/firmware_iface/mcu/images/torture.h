/* Work of many kinds that ends in one checksum: compiled for the emulated core and for the host it must be
 * the same. C that is also C++. No contraction of a * b + c, no library function whose last bit is free. */
#pragma once
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct {
  uint32_t crc;
  uint32_t random;
} Torture;

static void mix(Torture *t, uint32_t value) {
  for (int byte = 0; byte < 4; byte++) {
    t->crc ^= value >> (8 * byte) & 255u;
    for (int i = 0; i < 8; i++) t->crc = (t->crc >> 1) ^ (0xEDB88320u & (0u - (t->crc & 1u)));
  }
}
static void mix64(Torture *t, uint64_t value) {
  mix(t, (uint32_t)value);
  mix(t, (uint32_t)(value >> 32));
}
static void mix_float(Torture *t, float value) {
  uint32_t raw;
  memcpy(&raw, &value, 4);
  mix(t, raw);
}
static void mix_double(Torture *t, double value) {
  uint64_t raw;
  memcpy(&raw, &value, 8);
  mix64(t, raw);
}
static uint32_t draw(Torture *t) {
  t->random ^= t->random << 13;
  t->random ^= t->random >> 17;
  t->random ^= t->random << 5;
  return t->random;
}

static void integers(Torture *t) {
  for (int i = 0; i < 60; i++) {
    const uint32_t a = draw(t), b = draw(t) | 1u;
    const int32_t sa = (int32_t)a, sb = (int32_t)(b >> 3 | 1u);
    const uint64_t wide = (uint64_t)a << 32 | b;
    const int64_t swide = (int64_t)wide;
    mix(t, a / b), mix(t, a % b), mix(t, (uint32_t)(sa / sb)), mix(t, (uint32_t)(sa % sb));
    mix64(t, wide / (b >> 7 | 1u)), mix64(t, (uint64_t)(swide / sb)), mix64(t, (uint64_t)a * b);
    mix64(t, (uint64_t)((int64_t)sa * sb)), mix64(t, wide >> (a & 31)),
        mix64(t, (uint64_t)(swide >> (b & 31)));
    mix(t, (uint32_t)(uint8_t)a + (uint32_t)(int8_t)b), mix(t, (uint32_t)(int16_t)a * (uint32_t)(uint16_t)b);
    mix(t,
        (uint32_t)__builtin_clz(b) + (uint32_t)__builtin_popcount(a) + (uint32_t)__builtin_ctz(b << 3 | 8u));
    mix(t, __builtin_bswap32(a) ^ (a << (b & 31) | a >> (31 - (b & 31)) >> 1));
  }
}

static void floats(Torture *t) {
  float x = 0.5f, y = -1.25f;
  double u = 0.1, v = 3.7;
  for (int i = 0; i < 80; i++) {
    const float f = (float)(int32_t)draw(t) * 1e-5f, g = (float)draw(t) * 3e-6f + 0.25f;
    x = x * 0.75f + f / g;
    y = y - x * 0.125f + (f > g ? g : -f);
    mix_float(t, x), mix_float(t, y), mix_float(t, f / 3.f);
    mix(t, (uint32_t)(int32_t)(y * 0.5f)), mix(t, (uint32_t)(g * 1000.f));
    mix(t, (uint32_t)(x < y) << 3 | (uint32_t)(x <= g) << 2 | (uint32_t)(f != g) << 1 | (uint32_t)(y >= 0.f));
    u = u * 1.0001 + (double)f;
    v = v / 1.37 - u * 1e-3;
    mix_double(t, u), mix_double(t, v), mix_double(t, (double)(int32_t)draw(t) * v);
    mix_float(t, (float)u), mix(t, (uint32_t)(int32_t)v), mix64(t, (uint64_t)(int64_t)(u * 1e6));
    mix_double(t, (double)draw(t) + (double)x);
  }
}

typedef struct {
  uint8_t kind;
  uint16_t size : 9, flags : 7;
  int32_t signed_part : 11;
  uint32_t rest : 21;
  double weight;
} Record;

static int less(const Record *a, const Record *b) {
  return a->weight != b->weight ? a->weight < b->weight : a->rest < b->rest;
}
static void sort(Record *begin, int count, int (*in_order)(const Record *, const Record *)) {
  if (count < 2) return;
  const Record pivot = begin[count / 2];
  int low = 0, high = count - 1;
  while (low <= high) {
    while (in_order(&begin[low], &pivot)) low++;
    while (in_order(&pivot, &begin[high])) high--;
    if (low > high) break;
    const Record kept = begin[low];
    begin[low++] = begin[high];
    begin[high--] = kept;
  }
  sort(begin, high + 1, in_order);
  sort(begin + low, count - low, in_order);
}
static void records(Torture *t) {
  Record all[40];
  memset(all, 0, sizeof all);
  for (int i = 0; i < 40; i++) {
    all[i].kind = (uint8_t)draw(t);
    all[i].size = draw(t) & 511u;
    all[i].flags = draw(t) & 127u;
    all[i].signed_part = (int32_t)(draw(t) % 2047u) - 1023;
    all[i].rest = draw(t) & 0x1FFFFFu;
    all[i].weight = (double)(draw(t) % 17u) / 3.0;
  }
  sort(all, 40, less);
  for (int i = 0; i < 40; i++) {
    mix(t, all[i].kind), mix(t, all[i].size), mix(t, all[i].flags), mix(t, (uint32_t)all[i].signed_part);
    mix(t, all[i].rest), mix_double(t, all[i].weight);
  }
}

static uint32_t dispatch(uint32_t op, uint32_t a, uint32_t b) {
  switch (op % 11u) {
    case 0:
      return a + b;
    case 1:
      return a - b;
    case 2:
      return a ^ b;
    case 3:
      return a & ~b;
    case 4:
      return a | b;
    case 5:
      return a << (b & 15u);
    case 6:
      return a >> (b & 15u);
    case 7:
      return (uint32_t)((int32_t)a >> (b & 15u));
    case 8:
      return a * b;
    case 9:
      return b == 0 ? a : a % b;
    default:
      return (uint32_t) - (int32_t)(a >> 1);
  }
}
static uint32_t ackermann(uint32_t m, uint32_t n) {
  if (m == 0) return n + 1;
  return n == 0 ? ackermann(m - 1, 1) : ackermann(m - 1, ackermann(m, n - 1));
}
static void control_flow(Torture *t) {
  uint32_t value = 1;
  for (uint32_t i = 0; i < 500; i++) {
    const uint32_t op = draw(t), operand = draw(t);
    value = dispatch(op, value, operand);
  }
  mix(t, value);
  mix(t, ackermann(2, 7));
}

static void bytes(Torture *t) {
  char text[96], other[96];
  for (int round = 0; round < 20; round++) {
    const size_t length = 1 + draw(t) % 80u, from = draw(t) % 8u;
    for (size_t i = 0; i < length; i++) text[i] = (char)('a' + draw(t) % 26u);
    text[length] = 0;
    memset(other, 0, sizeof other);
    memcpy(other + from, text, length + 1);
    memmove(other + from / 2, other + from, length + 1);
    mix(t, (uint32_t)strlen(other + from / 2)), mix(t, (uint32_t)(strcmp(text, other + from / 2) == 0));
    mix(t, (uint32_t)(strchr(text, 'q') != NULL)), mix(t, (uint32_t)(memcmp(text, other, length) > 0));
    for (size_t i = 0; i < sizeof other; i += 4) {
      uint32_t word;
      memcpy(&word, other + i, 4);
      mix(t, word);
    }
  }
}

static uint32_t torture_crc(void) {
  Torture t = {0xFFFFFFFFu, 2463534242u};
  integers(&t);
  floats(&t);
  records(&t);
  control_flow(&t);
  bytes(&t);
  return t.crc;
}
