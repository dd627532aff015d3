/* Makes a pty look like a serial port to libserialport, which asks sysfs and the modem lines. Preloaded by
 * tests. Writes a line to the file named by OMNIHIL_PRELOAD_LOG for each modem line call: libserialport alone
 * makes them. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

static const char kSysfs[] = "/sys/class/tty/pts/";
static int is_pty(const char* path) { return strncmp(path, kSysfs, sizeof kSysfs - 1) == 0; }

static void note(const char* text) {
  const char* name = getenv("OMNIHIL_PRELOAD_LOG");
  int file = name ? open(name, O_WRONLY | O_CREAT | O_APPEND, 0644) : -1;
  if (file < 0) return;
  if (write(file, text, strlen(text)) < 0) _exit(99);
  close(file);
}

/* The name under which libserialport's build knows lstat(). */
int __lxstat(int version, const char* path, struct stat* out) {
  static int (*real)(int, const char*, struct stat*);
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "__lxstat");
  if (!is_pty(path)) return real(version, path, out);
  memset(out, 0, sizeof *out);
  out->st_mode = S_IFLNK | 0777;
  return 0;
}

ssize_t readlink(const char* path, char* out, size_t size) {
  static ssize_t (*real)(const char*, char*, size_t);
  static const char kLink[] = "../../devices/platform/serial8250/tty/ttyS9";
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "readlink");
  if (!is_pty(path)) return real(path, out, size);
  size_t n = sizeof kLink - 1 < size ? sizeof kLink - 1 : size;
  memcpy(out, kLink, n);
  return (ssize_t)n;
}

int ioctl(int fd, unsigned long request, ...) {
  static int (*real)(int, unsigned long, void*);
  va_list list;
  va_start(list, request);
  void* argument = va_arg(list, void*);
  va_end(list);
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "ioctl");
  if (request == TIOCMGET) {
    note("modem lines read\n");
    *(int*)argument = 0;
    return 0;
  }
  if (request == TIOCMSET || request == TIOCMBIS || request == TIOCMBIC) {
    note("modem lines set\n");
    return 0;
  }
  return real(fd, request, argument);
}
