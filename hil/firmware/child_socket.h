// The socket to a child process that may hang.
//
//   const int descriptor = 3;
//   if (!socket_ready(descriptor, POLLIN, 10.0)) return;  // nothing in ten seconds: it is ended
#pragma once
#include <poll.h>

namespace omnihil {

// True once the socket is ready for `what` (POLLIN, POLLOUT); false when that took longer than the deadline.
bool socket_ready(int socket, short what, double deadline_s);

}  // namespace omnihil
