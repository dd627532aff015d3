#include "hil/firmware/signal_words.h"

#include <fmt/format.h>

#include <csignal>

namespace omnihil {

std::string signal_words(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "SIGSEGV, memory that is not its own";
    case SIGBUS:
      return "SIGBUS, memory that is not there";
    case SIGFPE:
      return "SIGFPE, division by zero of integers";
    case SIGILL:
      return "SIGILL, not an instruction";
    case SIGABRT:
      return "SIGABRT, it called abort()";
    case SIGKILL:
      return "it cut its connection to the bench";
    default:
      return fmt::format("signal {}", signal);
  }
}

}  // namespace omnihil
