#include "hil/text/program_files.h"

#include <sys/auxv.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace omnihil {
namespace {

namespace fs = std::filesystem;

// The running program's folder: from /proc, else (no /proc in a bare chroot) from the path that it was started by.
fs::path program_folder() {
  std::error_code error;
  fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) {
    // The kernel gives the address as a number.
    const auto* started_as =
        reinterpret_cast<const char*>(::getauxval(AT_EXECFN));  // NOLINT(performance-no-int-to-ptr)
    program = fs::canonical(started_as == nullptr ? "" : started_as, error);
  }
  return program.parent_path();
}

}  // namespace

std::string data_folder(const std::string& name) {
  const fs::path wanted = (program_folder() / "../share/omnihil" / name).lexically_normal();
  std::error_code error;
  const fs::path found = fs::canonical(wanted, error);
  return (error ? wanted : found).string();
}

std::string helper_program(const std::string& name) {
  const fs::path here = program_folder();
  for (const fs::path& path : {here / "../libexec/omnihil" / name, here / name}) {
    if (::access(path.c_str(), X_OK) == 0) return path.lexically_normal().string();
  }
  return name;
}

}  // namespace omnihil
