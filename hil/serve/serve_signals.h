// Ctrl-C and its relatives as a flag that the loop looks at.
//
//   StopSignals stop;             // from here on SIGINT, SIGTERM, SIGHUP set the flag; SIGPIPE is ignored
//   while (!stop.requested()) …
//
// The handlers are installed without SA_RESTART, so a sleeping loop wakes at once. One at a time.
#pragma once
#include <signal.h>

#include <array>

namespace omnihil {

class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static bool requested();

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGPIPE};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace omnihil
