// Prints the status from a thread of its own, so that a terminal that is held (Ctrl-S) or slow never stalls
// the loop: the loop leaves a snapshot and goes on, or skips it when the printer is just taking one.
//
//   StatusPrinter printer(stdout);
//   printer.post(status);     // from the loop, about ten times a second
//   printer.stop();           // last line ended; also by the destructor
//
// On a terminal: one line, rewritten at most 10 times a second, never wider than the terminal. Elsewhere
// (a log file, a pipe): a line every 10 s.
#pragma once
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

#include "hil/serve/status.h"

namespace omnihil {

class StatusPrinter {
 public:
  explicit StatusPrinter(std::FILE* out);
  ~StatusPrinter() { stop(); }
  StatusPrinter(const StatusPrinter&) = delete;
  StatusPrinter& operator=(const StatusPrinter&) = delete;

  void post(const ServeStatus& status);  // never waits
  void stop();

 private:
  void run();
  void print(const ServeStatus& status);

  std::FILE* out_;
  bool terminal_;
  bool line_open_ = false;  // the cursor stands behind a status line
  std::mutex mutex_;
  std::condition_variable changed_;
  ServeStatus status_;
  bool fresh_ = false;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace omnihil
