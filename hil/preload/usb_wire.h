/* The virtual USB devices of a process, each the bytes of a serial device that `omnihil serve` made.
 *
 *   OMNIHIL_USB='03eb:6127=./dongle'                  one device by vendor and product
 *   OMNIHIL_USB='0483:5740=./dongle,length_at=10'     a transfer to the host ends with each packet: its length stands in
 *                                                     byte 10; without this it ends with what there is
 * Several devices are separated by ';'.
 */
#pragma once
#include <pthread.h>
#include <stddef.h>
#include <stdint.h>

#define USB_WIRE_DEVICES 4
#define USB_WIRE_BUFFER 16384

struct usb_wire {
  uint16_t vendor, product;
  char path[256];
  int length_at; /* -1: no packet says its length */
  int fd;        /* -1: not open */
  uint8_t waiting[USB_WIRE_BUFFER];
  size_t fill;
  pthread_mutex_t lock;
};

/* The devices that the environment names; their number. Says on stderr what it does not understand. */
int usb_wire_devices(struct usb_wire **devices);

/* 0, or -1 with errno. */
int usb_wire_open(struct usb_wire *wire);
void usb_wire_close(struct usb_wire *wire);
/* Bytes written until the deadline, less only where the other end does not read; -1: the device is gone. */
int usb_wire_write(struct usb_wire *wire, const uint8_t *bytes, int size, unsigned timeout_ms);
/* One transfer: at least a byte, 0 at the time-out (0: none), -1: the device is gone. */
int usb_wire_read(struct usb_wire *wire, uint8_t *bytes, int size, unsigned timeout_ms);
/* Whether a read would bring something now. */
int usb_wire_ready(struct usb_wire *wire);
