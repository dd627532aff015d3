/* A host that talks to its dongle by libusb, as it is written for the real stick; usb_preload puts the bench in its place.
 *
 *   libusb_client sync|async VENDOR PRODUCT INTERFACE OUT IN HEX COUNT    endpoints in hex; writes the bytes again and again until
 *                                                                       COUNT transfers came back, each a line of hex
 * Exit code 3: there is no such device.
 */
#define _GNU_SOURCE
#include <libusb-1.0/libusb.h>
#include <time.h>

#include "tests/clients/ask.h"

enum { kTransfer = 4096, kNoDevice = 3, kPause_ms = 20 };

static int g_left;

static long long now_ms(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1000LL + t.tv_nsec / 1000000;
}

static void print(const unsigned char* bytes, int size) {
  for (int i = 0; i < size; ++i) printf("%02x", bytes[i]);
  printf("\n");
}

static int ask_sync(libusb_device_handle* dongle, unsigned char out, unsigned char in, unsigned char* request,
                    int size) {
  unsigned char answer[kTransfer];
  while (g_left > 0) {
    int n = 0;
    if (libusb_bulk_transfer(dongle, out, request, size, &n, kDeadline_ms) != 0 || n != size)
      return fail("not written");
    for (;;) {
      const int error = libusb_bulk_transfer(dongle, in, answer, sizeof answer, &n, kPause_ms);
      if (error == LIBUSB_ERROR_TIMEOUT) break;
      if (error != 0) return fail(libusb_error_name(error));
      if (g_left-- > 0) print(answer, n);
    }
  }
  return 0;
}

static void LIBUSB_CALL came(struct libusb_transfer* transfer) {
  if (transfer->status == LIBUSB_TRANSFER_COMPLETED && g_left > 0) {
    print(transfer->buffer, transfer->actual_length);
    --g_left;
  }
  if (transfer->status == LIBUSB_TRANSFER_CANCELLED || libusb_submit_transfer(transfer) != 0)
    *(int*)transfer->user_data = 0;
}
static void LIBUSB_CALL went(struct libusb_transfer* transfer) { *(int*)transfer->user_data = 0; }

static int ask_async(libusb_device_handle* dongle, unsigned char out, unsigned char in,
                     unsigned char* request, int size) {
  static unsigned char answer[kTransfer];
  int listens = 1, writes = 0;
  long long next_ms = 0;
  struct libusb_transfer* from = libusb_alloc_transfer(0);
  struct libusb_transfer* to = libusb_alloc_transfer(0);
  libusb_fill_bulk_transfer(from, dongle, in, answer, sizeof answer, came, &listens, 0);
  libusb_fill_bulk_transfer(to, dongle, out, request, size, went, &writes, kDeadline_ms);
  if (libusb_submit_transfer(from) != 0) return fail("not listened");
  while (g_left > 0 && listens) {
    struct timeval pause = {0, kPause_ms * 1000};
    if (!writes && now_ms() >= next_ms) {
      writes = 1;
      next_ms = now_ms() + kPause_ms;
      if (libusb_submit_transfer(to) != 0) return fail("not written");
    }
    if (libusb_handle_events_timeout(NULL, &pause) != 0) return fail("no events");
  }
  if (libusb_cancel_transfer(from) != 0) return fail("not cancelled");
  while (listens || writes) libusb_handle_events(NULL);
  libusb_free_transfer(from);
  libusb_free_transfer(to);
  return 0;
}

int main(int count, char** words) {
  unsigned char request[kMostBytes];
  libusb_device_handle* dongle;
  struct libusb_device_descriptor said;
  int size, interface, code;
  unsigned char out, in;
  unsigned short vendor, product;
  if (count != 9 || (size = bytes_of(words[7], request)) < 0)
    return fail("WAY VENDOR PRODUCT INTERFACE OUT IN HEX COUNT");
  vendor = (unsigned short)strtol(words[2], NULL, 16);
  product = (unsigned short)strtol(words[3], NULL, 16);
  interface = atoi(words[4]);
  out = (unsigned char)strtol(words[5], NULL, 16);
  in = (unsigned char)strtol(words[6], NULL, 16);
  g_left = atoi(words[8]);
  if (libusb_init(NULL) != 0) return kNoDevice;
  dongle = libusb_open_device_with_vid_pid(NULL, vendor, product);
  if (!dongle) return kNoDevice;
  if (libusb_get_device_descriptor(libusb_get_device(dongle), &said) != 0 || said.idVendor != vendor)
    return fail("another device");
  if (libusb_kernel_driver_active(dongle, interface) != 0) return fail("a driver holds it");
  if (libusb_claim_interface(dongle, interface) != 0) return fail("not claimed");
  code = words[1][0] == 's' ? ask_sync(dongle, out, in, request, size)
                            : ask_async(dongle, out, in, request, size);
  libusb_release_interface(dongle, interface);
  libusb_close(dongle);
  libusb_exit(NULL);
  return code;
}
