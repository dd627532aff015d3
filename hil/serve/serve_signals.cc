#include "hil/serve/serve_signals.h"

namespace omnihil {
namespace {
volatile sig_atomic_t stop_requested = 0;
extern "C" void omnihil_on_stop_signal(int) { stop_requested = 1; }
}  // namespace

StopSignals::StopSignals() {
  stop_requested = 0;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction action {};
    action.sa_handler = kSignals[i] == SIGPIPE ? SIG_IGN : omnihil_on_stop_signal;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(kSignals[i], &action, &before_[i]);
    // Started under nohup: the terminal's end is not ours.
    if (kSignals[i] == SIGHUP && before_[i].sa_handler == SIG_IGN) ::sigaction(SIGHUP, &before_[i], nullptr);
  }
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
}

bool StopSignals::requested() { return stop_requested != 0; }

}  // namespace omnihil
