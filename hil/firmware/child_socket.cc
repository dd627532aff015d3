#include "hil/firmware/child_socket.h"

#include <poll.h>

#include <cerrno>

namespace omnihil {

bool socket_ready(int socket, short what, double deadline_s) {
  pollfd poll{socket, what, 0};
  for (;;) {
    const int ready = ::poll(&poll, 1, static_cast<int>(deadline_s * 1e3));
    if (ready > 0) return true;
    if (ready < 0 && errno == EINTR) continue;
    return false;
  }
}

}  // namespace omnihil
