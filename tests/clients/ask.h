/* What the serial clients of clients.py have in common: "DEVICE HEX COUNT" in, the hex of COUNT answers out.
 *
 *   client ./dongle 0401fe0101010a00 1      prints what came back up to and with the first 00 byte
 */
#pragma once
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kMostBytes = 256, kDeadline_ms = 60000 };

/* Hexadecimal to bytes; how many, -1 when it is none or too long. */
static inline int bytes_of(const char* hex, unsigned char* out) {
  const size_t size = strlen(hex) / 2;
  if (size > kMostBytes || strlen(hex) % 2 != 0) return -1;
  for (size_t i = 0; i < size; ++i) {
    unsigned byte;
    if (sscanf(hex + 2 * i, "%2x", &byte) != 1) return -1;
    out[i] = (unsigned char)byte;
  }
  return (int)size;
}

static inline int fail(const char* what) {
  fprintf(stderr, "%s\n", what);
  return 1;
}
