#include "hil/firmware/child_program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <system_error>

namespace omnihil {

std::string child_program(const std::string& name, const std::string& built) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error);
  for (const fs::path& path : {here.parent_path() / name, fs::path(built)}) {
    if (!error && ::access(path.c_str(), X_OK) == 0) return path.string();
  }
  return name;
}

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
