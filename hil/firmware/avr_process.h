// The program omnihil-avr, which runs one AVR chip, seen from the bench: lines to it, lines from it, and how
// it ended. What the lines say: docs/mcu-avr.md.
//
//   AvrProcess process(10.0);                    // throws std::runtime_error if it is not there
//   process.send("run 500000 0 0x0p+0 0x0p+0");
//   std::string line;
//   while (process.receive(line)) …              // false: it is no more, and end() says why
//
// The deadline is of wall time and for hangs alone: an answer that comes is the same whenever it comes.
#pragma once
#include <sys/types.h>

#include <string>

namespace omnihil {

class AvrProcess {
 public:
  explicit AvrProcess(double deadline_s);
  ~AvrProcess();
  AvrProcess(const AvrProcess&) = delete;
  AvrProcess& operator=(const AvrProcess&) = delete;

  void send(const std::string& line);
  bool receive(std::string& line);
  const std::string& end() const { return end_; }  // empty: it lives

 private:
  void start();
  bool wait_for(short what);
  void note_end(bool hung);

  double deadline_s_;
  int socket_ = -1;
  pid_t child_ = -1;
  std::string in_, end_;
};

}  // namespace omnihil
