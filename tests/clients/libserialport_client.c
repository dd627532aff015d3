/* A host that uses libserialport, which takes a pty for a port only with serial_preload. See ask.h. */
#include <libserialport.h>

#include "tests/clients/ask.h"

int main(int count, char** words) {
  unsigned char request[kMostBytes], byte = 1;
  struct sp_port* port = NULL;
  const int size = count == 4 ? bytes_of(words[2], request) : -1;
  if (size < 0) return fail("DEVICE HEX COUNT");
  if (sp_get_port_by_name(words[1], &port) != SP_OK || sp_open(port, SP_MODE_READ_WRITE) != SP_OK) {
    return fail("libserialport did not open the device");
  }
  if (sp_set_baudrate(port, 115200) != SP_OK || sp_set_bits(port, 8) != SP_OK ||
      sp_set_parity(port, SP_PARITY_NONE) != SP_OK || sp_set_stopbits(port, 1) != SP_OK ||
      sp_set_flowcontrol(port, SP_FLOWCONTROL_NONE) != SP_OK) {
    return fail("the line's settings were refused");
  }
  for (int left = atoi(words[3]); left > 0; --left) {
    if (sp_blocking_write(port, request, (size_t)size, kDeadline_ms) != size) return fail("not written");
    for (byte = 1; byte != 0;) {
      if (sp_blocking_read(port, &byte, 1, kDeadline_ms) != 1) return fail("no answer");
      printf("%02x", byte);
    }
    printf("\n");
  }
  sp_close(port);
  sp_free_port(port);
  return 0;
}
