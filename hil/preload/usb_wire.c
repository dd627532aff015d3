#define _GNU_SOURCE
#include "hil/preload/usb_wire.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

static struct usb_wire g_devices[USB_WIRE_DEVICES];
static int g_count;
static pthread_once_t g_once = PTHREAD_ONCE_INIT;

static int64_t now_ms(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000 + t.tv_nsec / 1000000;
}

/* What is left of the time for poll(); -1: for ever. */
static int left_ms(int64_t end_ms) {
  int64_t left;
  if (end_ms < 0) return -1;
  left = end_ms - now_ms();
  return left < 0 ? 0 : left > 1000000 ? 1000000 : (int)left;
}

static int read_device(const char *text, struct usb_wire *wire) {
  unsigned vendor = 0, product = 0;
  int at = 0;
  const char *option = strstr(text, ",length_at=");
  size_t size = option ? (size_t)(option - text) : strlen(text);
  if (sscanf(text, "%4x:%4x=%n", &vendor, &product, &at) != 2 || at == 0 || size <= (size_t)at) return 0;
  size -= (size_t)at;
  if (size >= sizeof wire->path) return 0;
  memcpy(wire->path, text + at, size);
  wire->path[size] = 0;
  wire->vendor = (uint16_t)vendor;
  wire->product = (uint16_t)product;
  wire->length_at = option ? atoi(option + strlen(",length_at=")) : -1;
  wire->fd = -1;
  pthread_mutex_init(&wire->lock, NULL);
  return 1;
}

static void read_environment(void) {
  const char *words = getenv("OMNIHIL_USB");
  char *copy = words ? strdup(words) : NULL;
  char *rest = copy, *one;
  while (rest && (one = strsep(&rest, ";"))) {
    if (g_count == USB_WIRE_DEVICES || !read_device(one, &g_devices[g_count])) {
      fprintf(stderr, "omnihil usb: OMNIHIL_USB: not understood: %s (allowed: 03eb:6127=PATH)\n", one);
    } else {
      ++g_count;
    }
  }
  free(copy);
}

int usb_wire_devices(struct usb_wire **devices) {
  pthread_once(&g_once, read_environment);
  *devices = g_devices;
  return g_count;
}

int usb_wire_open(struct usb_wire *wire) {
  struct termios line;
  if (wire->fd >= 0) return 0;
  wire->fd = open(wire->path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (wire->fd < 0) return -1;
  wire->fill = 0;
  if (tcgetattr(wire->fd, &line) == 0) {
    cfmakeraw(&line);
    tcsetattr(wire->fd, TCSANOW, &line);
  }
  return 0;
}

void usb_wire_close(struct usb_wire *wire) {
  if (wire->fd >= 0) close(wire->fd);
  wire->fd = -1;
}

int usb_wire_write(struct usb_wire *wire, const uint8_t *bytes, int size, unsigned timeout_ms) {
  const int64_t end_ms = timeout_ms == 0 ? -1 : now_ms() + timeout_ms;
  int done = 0;
  while (done < size) {
    struct pollfd asked = {wire->fd, POLLOUT, 0};
    const ssize_t n = write(wire->fd, bytes + done, (size_t)(size - done));
    if (n > 0) {
      done += (int)n;
    } else if (n < 0 && errno != EAGAIN && errno != EINTR) {
      return -1;
    } else if (poll(&asked, 1, left_ms(end_ms)) == 0) {
      break;
    }
  }
  return done;
}

/* The next transfer's length: a packet's, or all that waits; 0: none is whole. */
static size_t whole(const struct usb_wire *wire) {
  size_t length;
  if (wire->length_at < 0) return wire->fill;
  if (wire->fill <= (size_t)wire->length_at) return 0;
  length = wire->waiting[wire->length_at];
  if (length <= (size_t)wire->length_at) return wire->fill; /* no length: what there is */
  return length <= wire->fill ? length : 0;
}

/* Takes what waits on the line; 0: the device is gone. */
static int take_in(struct usb_wire *wire) {
  while (wire->fill < sizeof wire->waiting) {
    const ssize_t n = read(wire->fd, wire->waiting + wire->fill, sizeof wire->waiting - wire->fill);
    if (n > 0) {
      wire->fill += (size_t)n;
    } else if (n < 0 && errno == EINTR) {
      continue;
    } else {
      return n < 0 && errno == EAGAIN;
    }
  }
  return 1;
}

int usb_wire_ready(struct usb_wire *wire) {
  int ready;
  pthread_mutex_lock(&wire->lock);
  ready = !take_in(wire) || whole(wire) > 0;
  pthread_mutex_unlock(&wire->lock);
  return ready;
}

int usb_wire_read(struct usb_wire *wire, uint8_t *bytes, int size, unsigned timeout_ms) {
  const int64_t end_ms = timeout_ms == 0 ? -1 : now_ms() + timeout_ms;
  for (;;) {
    struct pollfd asked = {wire->fd, POLLIN, 0};
    size_t count;
    int there;
    pthread_mutex_lock(&wire->lock);
    there = take_in(wire);
    count = whole(wire);
    if (count > (size_t)size) count = (size_t)size;
    if (count > 0) {
      memcpy(bytes, wire->waiting, count);
      wire->fill -= count;
      memmove(wire->waiting, wire->waiting + count, wire->fill);
    }
    pthread_mutex_unlock(&wire->lock);
    if (count > 0) return (int)count;
    if (!there) return -1;
    if (left_ms(end_ms) == 0) return 0;
    poll(&asked, 1, left_ms(end_ms));
  }
}
