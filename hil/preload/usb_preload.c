/* libusb-1.0 as a host program calls it, answered by virtual devices in place of the computer's: for hosts that talk to
 * their dongle by libusb and not through a serial port.
 *
 *   OMNIHIL_USB='03eb:6127=./dongle' LD_PRELOAD=libomnihil_usb.so host
 *
 * Every device has two interfaces with a bulk endpoint each way; any endpoint is the one wire: OUT writes its bytes, IN
 * reads them (usb_wire.h). Control transfers succeed and bring nothing but strings. The computer's own devices are not
 * seen. Cannot: isochronous transfers, hot plug (there is none, as a host must expect), descriptors beyond the basic ones.
 * Source: libusb 1.0.26, libusb.h and its API reference.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <libusb-1.0/libusb.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "hil/preload/usb_wire.h"

#define EXPORTED __attribute__((visibility("default")))
#define INTERFACES 2

struct libusb_context {
  int unused;
};
struct libusb_device {
  int number;
};
struct libusb_device_handle {
  struct usb_wire *wire;
  libusb_device *device;
};

static struct libusb_context g_context;
static struct libusb_device g_devices[USB_WIRE_DEVICES] = {{0}, {1}, {2}, {3}};

static int count(void) {
  struct usb_wire *wires;
  return usb_wire_devices(&wires);
}

static struct usb_wire *wire_of(const libusb_device *device) {
  struct usb_wire *wires;
  usb_wire_devices(&wires);
  return &wires[device->number];
}

EXPORTED int libusb_init(libusb_context **context) {
  if (context) *context = &g_context;
  return 0;
}
EXPORTED void libusb_exit(libusb_context *context) { (void)context; }
EXPORTED void libusb_set_debug(libusb_context *context, int level) { (void)context, (void)level; }
EXPORTED int libusb_set_option(libusb_context *context, enum libusb_option option, ...) {
  (void)context, (void)option;
  return 0;
}
EXPORTED int libusb_has_capability(uint32_t capability) { return capability == LIBUSB_CAP_HAS_CAPABILITY; }

EXPORTED ssize_t libusb_get_device_list(libusb_context *context, libusb_device ***list) {
  const int n = count();
  (void)context;
  *list = calloc((size_t)n + 1, sizeof **list);
  if (!*list) return LIBUSB_ERROR_NO_MEM;
  for (int i = 0; i < n; ++i) (*list)[i] = &g_devices[i];
  return n;
}
EXPORTED void libusb_free_device_list(libusb_device **list, int unref) {
  (void)unref;
  free(list);
}
EXPORTED libusb_device *libusb_ref_device(libusb_device *device) { return device; }
EXPORTED void libusb_unref_device(libusb_device *device) { (void)device; }
EXPORTED uint8_t libusb_get_bus_number(libusb_device *device) {
  (void)device;
  return 1;
}
EXPORTED uint8_t libusb_get_device_address(libusb_device *device) { return (uint8_t)(device->number + 1); }
EXPORTED uint8_t libusb_get_port_number(libusb_device *device) { return (uint8_t)(device->number + 1); }
EXPORTED int libusb_get_device_speed(libusb_device *device) {
  (void)device;
  return LIBUSB_SPEED_FULL;
}
EXPORTED int libusb_get_max_packet_size(libusb_device *device, unsigned char endpoint) {
  (void)device, (void)endpoint;
  return 64;
}

EXPORTED int libusb_get_device_descriptor(libusb_device *device, struct libusb_device_descriptor *out) {
  const struct usb_wire *wire = wire_of(device);
  memset(out, 0, sizeof *out);
  out->bLength = LIBUSB_DT_DEVICE_SIZE;
  out->bDescriptorType = LIBUSB_DT_DEVICE;
  out->bcdUSB = 0x0200;
  out->bMaxPacketSize0 = 64;
  out->idVendor = wire->vendor;
  out->idProduct = wire->product;
  out->iManufacturer = 1;
  out->iProduct = 2;
  out->iSerialNumber = 3;
  out->bNumConfigurations = 1;
  return 0;
}

EXPORTED int libusb_get_active_config_descriptor(libusb_device *device,
                                                 struct libusb_config_descriptor **out) {
  static const struct libusb_endpoint_descriptor kEndpoints[2] = {{.bLength = 7,
                                                                   .bDescriptorType = LIBUSB_DT_ENDPOINT,
                                                                   .bEndpointAddress = 0x81,
                                                                   .bmAttributes = 2,
                                                                   .wMaxPacketSize = 64},
                                                                  {.bLength = 7,
                                                                   .bDescriptorType = LIBUSB_DT_ENDPOINT,
                                                                   .bEndpointAddress = 0x01,
                                                                   .bmAttributes = 2,
                                                                   .wMaxPacketSize = 64}};
  static const struct libusb_interface_descriptor kSettings[INTERFACES] = {
      {.bLength = 9,
       .bDescriptorType = LIBUSB_DT_INTERFACE,
       .bInterfaceNumber = 0,
       .bNumEndpoints = 2,
       .bInterfaceClass = 0xFF,
       .endpoint = kEndpoints},
      {.bLength = 9,
       .bDescriptorType = LIBUSB_DT_INTERFACE,
       .bInterfaceNumber = 1,
       .bNumEndpoints = 2,
       .bInterfaceClass = 0xFF,
       .endpoint = kEndpoints}};
  static const struct libusb_interface kInterfaces[INTERFACES] = {{&kSettings[0], 1}, {&kSettings[1], 1}};
  (void)device;
  *out = calloc(1, sizeof **out);
  if (!*out) return LIBUSB_ERROR_NO_MEM;
  (*out)->bLength = LIBUSB_DT_CONFIG_SIZE;
  (*out)->bDescriptorType = LIBUSB_DT_CONFIG;
  (*out)->bNumInterfaces = INTERFACES;
  (*out)->bConfigurationValue = 1;
  (*out)->interface = kInterfaces;
  return 0;
}
EXPORTED int libusb_get_config_descriptor(libusb_device *device, uint8_t index,
                                          struct libusb_config_descriptor **out) {
  return index == 0 ? libusb_get_active_config_descriptor(device, out) : LIBUSB_ERROR_NOT_FOUND;
}
EXPORTED int libusb_get_config_descriptor_by_value(libusb_device *device, uint8_t value,
                                                   struct libusb_config_descriptor **out) {
  return value == 1 ? libusb_get_active_config_descriptor(device, out) : LIBUSB_ERROR_NOT_FOUND;
}
EXPORTED void libusb_free_config_descriptor(struct libusb_config_descriptor *config) { free(config); }

EXPORTED int libusb_open(libusb_device *device, libusb_device_handle **out) {
  struct usb_wire *wire = wire_of(device);
  if (usb_wire_open(wire) != 0) return errno == EACCES ? LIBUSB_ERROR_ACCESS : LIBUSB_ERROR_NO_DEVICE;
  *out = calloc(1, sizeof **out);
  if (!*out) return LIBUSB_ERROR_NO_MEM;
  (*out)->wire = wire;
  (*out)->device = device;
  return 0;
}
EXPORTED libusb_device_handle *libusb_open_device_with_vid_pid(libusb_context *context, uint16_t vendor,
                                                               uint16_t product) {
  (void)context;
  for (int i = 0; i < count(); ++i) {
    libusb_device_handle *handle = NULL;
    const struct usb_wire *wire = wire_of(&g_devices[i]);
    if (wire->vendor == vendor && wire->product == product && libusb_open(&g_devices[i], &handle) == 0)
      return handle;
  }
  return NULL;
}
EXPORTED void libusb_close(libusb_device_handle *handle) {
  if (handle) usb_wire_close(handle->wire);
  free(handle);
}
EXPORTED libusb_device *libusb_get_device(libusb_device_handle *handle) { return handle->device; }
EXPORTED int libusb_get_configuration(libusb_device_handle *handle, int *config) {
  (void)handle;
  *config = 1;
  return 0;
}
EXPORTED int libusb_set_configuration(libusb_device_handle *handle, int config) {
  (void)handle;
  return config == 1 || config == -1 ? 0 : LIBUSB_ERROR_NOT_FOUND;
}
static int of_interface(int number) {
  return number >= 0 && number < INTERFACES ? 0 : LIBUSB_ERROR_NOT_FOUND;
}
EXPORTED int libusb_claim_interface(libusb_device_handle *handle, int number) {
  (void)handle;
  return of_interface(number);
}
EXPORTED int libusb_release_interface(libusb_device_handle *handle, int number) {
  (void)handle;
  return of_interface(number);
}
EXPORTED int libusb_set_interface_alt_setting(libusb_device_handle *handle, int number, int setting) {
  (void)handle;
  return setting == 0 ? of_interface(number) : LIBUSB_ERROR_NOT_FOUND;
}
EXPORTED int libusb_clear_halt(libusb_device_handle *handle, unsigned char endpoint) {
  (void)handle, (void)endpoint;
  return 0;
}
EXPORTED int libusb_reset_device(libusb_device_handle *handle) {
  (void)handle;
  return 0;
}
/* No driver of the computer's holds a virtual device. */
EXPORTED int libusb_kernel_driver_active(libusb_device_handle *handle, int number) {
  (void)handle, (void)number;
  return 0;
}
EXPORTED int libusb_detach_kernel_driver(libusb_device_handle *handle, int number) {
  (void)handle, (void)number;
  return LIBUSB_ERROR_NOT_FOUND;
}
EXPORTED int libusb_attach_kernel_driver(libusb_device_handle *handle, int number) {
  (void)handle, (void)number;
  return LIBUSB_ERROR_NOT_FOUND;
}
EXPORTED int libusb_set_auto_detach_kernel_driver(libusb_device_handle *handle, int enable) {
  (void)handle, (void)enable;
  return 0;
}
EXPORTED int libusb_get_string_descriptor_ascii(libusb_device_handle *handle, uint8_t index,
                                                unsigned char *data, int length) {
  static const char *const kStrings[] = {"", "omnihil", "virtual dongle", "1"};
  int size;
  (void)handle;
  if (index == 0 || index >= sizeof kStrings / sizeof *kStrings || length < 1)
    return LIBUSB_ERROR_INVALID_PARAM;
  size = (int)strlen(kStrings[index]);
  if (size > length - 1) size = length - 1;
  memcpy(data, kStrings[index], (size_t)size);
  data[size] = 0;
  return size;
}

EXPORTED int libusb_control_transfer(libusb_device_handle *handle, uint8_t type, uint8_t request,
                                     uint16_t value, uint16_t index, unsigned char *data, uint16_t length,
                                     unsigned timeout) {
  (void)handle, (void)request, (void)value, (void)index, (void)data, (void)timeout;
  return type & LIBUSB_ENDPOINT_IN ? 0 : length;
}

EXPORTED int libusb_bulk_transfer(libusb_device_handle *handle, unsigned char endpoint, unsigned char *data,
                                  int length, int *transferred, unsigned timeout) {
  const int in = endpoint & LIBUSB_ENDPOINT_IN;
  const int n = in ? usb_wire_read(handle->wire, data, length, timeout)
                   : usb_wire_write(handle->wire, data, length, timeout);
  if (transferred) *transferred = n < 0 ? 0 : n;
  if (n < 0) return LIBUSB_ERROR_NO_DEVICE;
  return (in ? n == 0 && length > 0 : n < length) ? LIBUSB_ERROR_TIMEOUT : 0;
}
EXPORTED int libusb_interrupt_transfer(libusb_device_handle *handle, unsigned char endpoint,
                                       unsigned char *data, int length, int *transferred, unsigned timeout) {
  return libusb_bulk_transfer(handle, endpoint, data, length, transferred, timeout);
}

EXPORTED const struct libusb_version *libusb_get_version(void) {
  static const struct libusb_version kVersion = {1, 0, 26, 0, "", "omnihil"};
  return &kVersion;
}
EXPORTED const char *libusb_error_name(int code) {
  switch (code) {
    case LIBUSB_SUCCESS:
      return "LIBUSB_SUCCESS";
    case LIBUSB_ERROR_ACCESS:
      return "LIBUSB_ERROR_ACCESS";
    case LIBUSB_ERROR_NO_DEVICE:
      return "LIBUSB_ERROR_NO_DEVICE";
    case LIBUSB_ERROR_NOT_FOUND:
      return "LIBUSB_ERROR_NOT_FOUND";
    case LIBUSB_ERROR_TIMEOUT:
      return "LIBUSB_ERROR_TIMEOUT";
    case LIBUSB_ERROR_NOT_SUPPORTED:
      return "LIBUSB_ERROR_NOT_SUPPORTED";
    default:
      return "LIBUSB_ERROR_OTHER";
  }
}
EXPORTED const char *libusb_strerror(int code) { return libusb_error_name(code); }

EXPORTED int libusb_hotplug_register_callback(libusb_context *context, int events, int flags, int vendor,
                                              int product, int device_class,
                                              libusb_hotplug_callback_fn callback, void *user,
                                              libusb_hotplug_callback_handle *handle) {
  (void)context, (void)events, (void)flags, (void)vendor, (void)product, (void)device_class, (void)callback,
      (void)user;
  (void)handle;
  return LIBUSB_ERROR_NOT_SUPPORTED;
}
EXPORTED void libusb_hotplug_deregister_callback(libusb_context *context,
                                                 libusb_hotplug_callback_handle handle) {
  (void)context, (void)handle;
}
