/* The asynchronous half of usb_preload.c: transfers that are submitted, and completed while the host handles events.
 *
 * An OUT transfer is written when it is submitted, an IN transfer waits for bytes, its time-out or its cancellation; all
 * callbacks come from libusb_handle_events and its like, as libusb has it. Each device's IN transfers complete in the order of
 * their submission.
 */
#define _GNU_SOURCE
#include <libusb-1.0/libusb.h>
#include <poll.h>
#include <stdlib.h>
#include <time.h>

#include "hil/preload/usb_wire.h"

#define EXPORTED __attribute__((visibility("default")))

struct libusb_device_handle { /* as in usb_preload.c */
  struct usb_wire *wire;
  libusb_device *device;
};

/* What stands in front of each transfer that libusb_alloc_transfer gives out. */
struct entry {
  struct entry *next;
  int64_t end_ms; /* -1: none */
  int submitted, done, cancelled, status, transferred;
};

static pthread_mutex_t g_lock = PTHREAD_MUTEX_INITIALIZER;
static struct entry *g_first;

static struct libusb_transfer *transfer_of(struct entry *entry) {
  return (struct libusb_transfer *)(entry + 1);
}
static struct entry *entry_of(struct libusb_transfer *transfer) { return (struct entry *)transfer - 1; }

static int64_t now_ms(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000 + t.tv_nsec / 1000000;
}

EXPORTED struct libusb_transfer *libusb_alloc_transfer(int iso_packets) {
  struct entry *entry = calloc(
      1, sizeof *entry + sizeof(struct libusb_transfer) +
             (size_t)(iso_packets < 0 ? 0 : iso_packets) * sizeof(struct libusb_iso_packet_descriptor));
  return entry ? transfer_of(entry) : NULL;
}
EXPORTED void libusb_free_transfer(struct libusb_transfer *transfer) {
  if (!transfer) return;
  if (transfer->flags & LIBUSB_TRANSFER_FREE_BUFFER) free(transfer->buffer);
  free(entry_of(transfer));
}

EXPORTED int libusb_submit_transfer(struct libusb_transfer *transfer) {
  struct entry *entry = entry_of(transfer);
  struct entry **last = &g_first;
  if (transfer->type != LIBUSB_TRANSFER_TYPE_BULK && transfer->type != LIBUSB_TRANSFER_TYPE_INTERRUPT)
    return LIBUSB_ERROR_NOT_SUPPORTED;
  pthread_mutex_lock(&g_lock);
  if (entry->submitted) {
    pthread_mutex_unlock(&g_lock);
    return LIBUSB_ERROR_BUSY;
  }
  entry->next = NULL;
  entry->end_ms = transfer->timeout == 0 ? -1 : now_ms() + transfer->timeout;
  entry->submitted = 1;
  entry->done = entry->cancelled = entry->transferred = 0;
  while (*last) last = &(*last)->next;
  *last = entry;
  if (!(transfer->endpoint & LIBUSB_ENDPOINT_IN)) {
    const int n =
        usb_wire_write(transfer->dev_handle->wire, transfer->buffer, transfer->length, transfer->timeout);
    entry->done = 1;
    entry->transferred = n < 0 ? 0 : n;
    entry->status = n < 0                  ? LIBUSB_TRANSFER_NO_DEVICE
                    : n < transfer->length ? LIBUSB_TRANSFER_TIMED_OUT
                                           : LIBUSB_TRANSFER_COMPLETED;
  }
  pthread_mutex_unlock(&g_lock);
  return 0;
}

EXPORTED int libusb_cancel_transfer(struct libusb_transfer *transfer) {
  struct entry *entry = entry_of(transfer);
  int found;
  pthread_mutex_lock(&g_lock);
  found = entry->submitted && !entry->cancelled;
  if (found) entry->cancelled = 1;
  pthread_mutex_unlock(&g_lock);
  return found ? 0 : LIBUSB_ERROR_NOT_FOUND;
}

/* Whether this transfer has come to its end now. */
static int finish(struct entry *entry) {
  struct libusb_transfer *transfer = transfer_of(entry);
  struct usb_wire *wire = transfer->dev_handle->wire;
  if (entry->done) return 1;
  if (usb_wire_ready(wire)) {
    const int n = usb_wire_read(wire, transfer->buffer, transfer->length, 1);
    entry->transferred = n < 0 ? 0 : n;
    entry->status = n < 0 ? LIBUSB_TRANSFER_NO_DEVICE : LIBUSB_TRANSFER_COMPLETED;
    entry->done = n != 0;
  }
  if (!entry->done && entry->cancelled) entry->status = LIBUSB_TRANSFER_CANCELLED, entry->done = 1;
  if (!entry->done && entry->end_ms >= 0 && now_ms() >= entry->end_ms)
    entry->status = LIBUSB_TRANSFER_TIMED_OUT, entry->done = 1;
  return entry->done;
}

/* Takes the first finished transfer out of the list; NULL: none is. An earlier one of a device keeps the later back. */
static struct entry *take_finished(void) {
  struct entry **at = &g_first;
  while (*at) {
    struct entry *entry = *at;
    int first = 1;
    for (struct entry *other = g_first; other != entry; other = other->next) {
      first &= other->done || transfer_of(other)->dev_handle->wire != transfer_of(entry)->dev_handle->wire;
    }
    if ((first || entry->done || entry->cancelled) && finish(entry)) {
      *at = entry->next;
      entry->submitted = 0;
      return entry;
    }
    at = &entry->next;
  }
  return NULL;
}

static int is_submitted(const struct entry *entry) {
  int submitted;
  pthread_mutex_lock(&g_lock);
  submitted = entry->submitted;
  pthread_mutex_unlock(&g_lock);
  return submitted;
}

/* One round: callbacks of all that is finished; their number. */
static int complete(void) {
  int completed = 0;
  for (;;) {
    struct libusb_transfer *transfer;
    struct entry *entry;
    int frees;
    pthread_mutex_lock(&g_lock);
    entry = take_finished();
    pthread_mutex_unlock(&g_lock);
    if (!entry) return completed;
    transfer = transfer_of(entry);
    transfer->status = entry->status;
    transfer->actual_length = entry->transferred;
    ++completed;
    /* A callback may free the transfer, but not one that is freed for it; it may submit that one again. */
    frees = transfer->flags & LIBUSB_TRANSFER_FREE_TRANSFER;
    if (transfer->callback) transfer->callback(transfer);
    if (frees && !is_submitted(entry)) libusb_free_transfer(transfer);
  }
}

EXPORTED int libusb_handle_events_timeout_completed(libusb_context *context, struct timeval *limit,
                                                    int *completed) {
  const int64_t end_ms = now_ms() + (limit ? (int64_t)limit->tv_sec * 1000 + limit->tv_usec / 1000 : 60000);
  (void)context;
  while (complete() == 0 && !(completed && *completed) && now_ms() < end_ms) {
    struct pollfd asked[USB_WIRE_DEVICES];
    struct usb_wire *wires;
    nfds_t n = 0;
    const int devices = usb_wire_devices(&wires);
    for (int i = 0; i < devices; ++i) {
      if (wires[i].fd >= 0) asked[n++] = (struct pollfd){wires[i].fd, POLLIN, 0};
    }
    poll(asked, n, 1); /* time-outs, cancellations and transfers of other threads are seen within it */
  }
  return 0;
}
EXPORTED int libusb_handle_events_timeout(libusb_context *context, struct timeval *limit) {
  return libusb_handle_events_timeout_completed(context, limit, NULL);
}
EXPORTED int libusb_handle_events_completed(libusb_context *context, int *completed) {
  struct timeval minute = {60, 0};
  return libusb_handle_events_timeout_completed(context, &minute, completed);
}
EXPORTED int libusb_handle_events(libusb_context *context) {
  return libusb_handle_events_completed(context, NULL);
}
EXPORTED void libusb_interrupt_event_handler(libusb_context *context) { (void)context; }
