#include "hil/wire/terminal.h"

#include <termios.h>

namespace omnihil {

// cfmakeraw leaves IXOFF, IXANY and CRTSCTS as they were.
bool make_raw(int fd) {
  termios modes{};
  if (::tcgetattr(fd, &modes) != 0) return false;
  ::cfmakeraw(&modes);
  modes.c_iflag &= ~static_cast<tcflag_t>(IXOFF | IXANY | INPCK);
  modes.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS);
  modes.c_cflag |= CLOCAL | CREAD;
  modes.c_cc[VMIN] = 1;
  modes.c_cc[VTIME] = 0;
  return ::tcsetattr(fd, TCSANOW, &modes) == 0;
}

}  // namespace omnihil
