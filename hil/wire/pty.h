// One pseudo-terminal, seen from the side of the device: what a dongle's USB serial port looks like to a
// host. libserialport and friends refuse to make one, so it is opened by hand.
//
//   std::string problem;
//   auto pty = Pty::open(problem);               // nullptr and the reason, or a raw pty
//   pty->slave_path();                           // "/dev/pts/5": what the host opens
//   pty->reset_line();                           // after a host left: raw, empty, open to anybody
//
// Presence. The slave is opened once and closed at the start, and then held by nobody here. From then on
// the kernel says EIO on a read of the master exactly when no host has the slave open AND everything the
// last host wrote has been read (pty(7); n_tty_read, TTY_OTHER_CLOSED): no byte is lost at a close. A host
// that closes and opens again between two reads would go unseen that way; inotify on the slave's node sees
// it (IN_CLOSE then IN_OPEN, in order). Without inotify (watch limit reached) only that case is missed.
//
// Modes. The line starts raw: a host that never touches termios gets bytes as they are. A host that asks
// for cooked modes (ECHO, ICANON, OPOST) gets what a real serial port would give it, for as long as it has
// the port open; reset_line() undoes them, lifts TIOCEXCL and empties both queues, as the last close of a
// real USB serial port does. Baud rate, parity and modem lines have no effect on a pty.
#pragma once
#include <memory>
#include <string>

namespace omnihil {

class Pty {
 public:
  static std::unique_ptr<Pty> open(std::string& problem);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  int master() const { return master_; }  // non-blocking
  const std::string& slave_path() const { return slave_path_; }
  // What hosts did since the last call.
  struct Events {
    bool reopened = false;  // the last host left and another one (or the same) came
    bool visited = false;   // somebody opened or closed it
  };
  Events take_events();
  // Fresh line for the next host. False: the slave cannot be opened (a host that died holding it
  // exclusively, TIOCEXCL, and we are not root): only a new pty helps.
  bool reset_line();

 private:
  Pty() = default;
  void watch();
  void forget();

  int master_ = -1;
  int notify_ = -1;  // inotify; -1 where there is none
  int watch_ = -1;
  int hosts_ = 0;      // opens minus closes seen; a lower bound, see take_events()
  bool left_ = false;  // the count went to 0
  std::string slave_path_;
};

}  // namespace omnihil
