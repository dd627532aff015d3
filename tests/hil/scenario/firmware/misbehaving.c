/* The reference firmware until tick 100, then the one thing that MISBEHAVE says. */
#define _GNU_SOURCE
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "tests/hil/scenario/firmware/wrapped.h"

enum {
  NULL_POINTER = 1,
  HANG,
  ABORT,
  EXIT,
  BEHIND_STATE, /* one byte behind its state block */
  FAR_BEHIND,   /* a page behind it */
  DEEP_RECURSION,
  HANG_IN_INIT,
  CRASH_AT_LOAD,
  REFUSES,
  LONG_FRAME,   /* radio_transmit claims more than it was given */
  NOT_A_NUMBER, /* a duty that is none */
  PRINTS,       /* chatters on its standard output */
  BAD_TABLE
};

static volatile int never_done = 1;
static volatile double sink;
static int* volatile nowhere;

static double recurse(int n) {
  volatile char room[4096];
  room[0] = (char)n;
  double deeper = recurse(n + 1);
  return deeper + room[0] + room[n % 4096];
}

static void misbehave(void* state, omnihil_drive* drive) {
  switch (MISBEHAVE) {
    case NULL_POINTER:
      *nowhere = 1;
      break;
    case HANG:
      while (never_done) sink += 1.0;
      break;
    case ABORT:
      abort();
    case EXIT:
      exit(3);
    case BEHIND_STATE:
      ((volatile char*)state)[reference()->state_bytes] = 1;
      break;
    case FAR_BEHIND:
      ((volatile char*)state)[reference()->state_bytes + 4096] = 1;
      break;
    case DEEP_RECURSION:
      sink = recurse(0);
      break;
    case NOT_A_NUMBER:
      drive->duty_ratio[1] = (double)NAN;
      break;
    case PRINTS:
      printf("chatter\n");
      fflush(stdout);
      break;
    default:
      break;
  }
}

static void tick(void* state, const omnihil_sensors* sensors, omnihil_drive* drive) {
  reference()->tick(state, sensors, drive);
  if (sensors->now_us >= 100000u) misbehave(state, drive);
}

static int init(void* state, const omnihil_robot_config* config) {
  while (MISBEHAVE == HANG_IN_INIT && never_done) sink += 1.0;
  return MISBEHAVE == REFUSES ? 7 : reference()->init(state, config);
}

static size_t radio_transmit(void* state, uint8_t* bytes, size_t capacity) {
  return MISBEHAVE == LONG_FRAME ? capacity + 1u : reference()->radio_transmit(state, bytes, capacity);
}

__attribute__((constructor)) static void at_load(void) {
  if (MISBEHAVE == CRASH_AT_LOAD) raise(SIGSEGV);
}

const omnihil_firmware_api* omnihil_firmware_get(uint32_t version) {
  static omnihil_firmware_api api;
  api = *reference();
  api.name = "misbehaving";
  api.init = init;
  api.tick = tick;
  api.radio_transmit = radio_transmit;
  if (MISBEHAVE == BAD_TABLE) {
    api.tick = NULL;
    api.control_period_us = 0;
  }
  return version == OMNIHIL_FIRMWARE_ABI ? &api : NULL;
}
