#include "hil/wire/pty.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "hil/wire/terminal.h"

namespace omnihil {
namespace {

int open_slave(int master) {
  return ::ioctl(master, TIOCGPTPEER, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
}

std::string failed(const char* call) { return std::string(call) + " failed: " + std::strerror(errno); }

}  // namespace

std::unique_ptr<Pty> Pty::open(std::string& problem) {
  std::unique_ptr<Pty> pty(new Pty);
  pty->master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (pty->master_ < 0) {
    problem = failed("opening a pseudo-terminal: posix_openpt");
    return nullptr;
  }
  std::array<char, 128> name{};
  if (::grantpt(pty->master_) != 0 || ::unlockpt(pty->master_) != 0 ||
      ::ptsname_r(pty->master_, name.data(), name.size()) != 0) {
    problem = failed("opening a pseudo-terminal: grantpt/unlockpt/ptsname");
    return nullptr;
  }
  pty->slave_path_ = name.data();
  pty->notify_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (!pty->reset_line()) {
    problem = failed(("opening the pseudo-terminal " + pty->slave_path_).c_str());
    return nullptr;
  }
  return pty;
}

Pty::~Pty() {
  if (notify_ >= 0) ::close(notify_);
  if (master_ >= 0) ::close(master_);
}

void Pty::watch() {
  if (notify_ >= 0) watch_ = ::inotify_add_watch(notify_, slave_path_.c_str(), IN_OPEN | IN_CLOSE);
}

void Pty::forget() {
  if (watch_ >= 0) ::inotify_rm_watch(notify_, watch_);
  watch_ = -1;
  hosts_ = 0;
  left_ = false;
}

// The kernel merges equal neighbours in the event queue, so two opens within one step count as one. Then a
// later close may look like the last one; the next open counts as a reopen although a host was there all
// along. Harm: that host's half packet, if it had one on the way, is dropped and counted.
Pty::Events Pty::take_events() {
  Events seen;
  if (watch_ < 0) return seen;
  alignas(inotify_event) std::array<char, 4096> events;
  ssize_t size = 0;
  while ((size = ::read(notify_, events.data(), events.size())) > 0) {
    for (ssize_t at = 0; at < size;) {
      inotify_event event{};
      std::memcpy(&event, events.data() + at, sizeof event);
      at += static_cast<ssize_t>(sizeof event + event.len);
      if (event.wd != watch_) continue;
      seen.visited = true;
      if (event.mask & IN_OPEN) {
        seen.reopened = seen.reopened || left_;
        left_ = false;
        ++hosts_;
      } else if (event.mask & IN_CLOSE) {
        if (hosts_ > 0) --hosts_;
        left_ = hosts_ == 0;
      }
    }
  }
  return seen;
}

bool Pty::reset_line() {
  forget();
  const int slave = open_slave(master_);
  const bool opened = slave >= 0;
  if (opened) {
    make_raw(slave);
    ::ioctl(slave, TIOCNXCL);
    ::tcflush(slave, TCIFLUSH);
    ::close(slave);
  }
  watch();
  return opened;
}

}  // namespace omnihil
