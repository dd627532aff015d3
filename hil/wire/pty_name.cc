#include "hil/wire/pty_name.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace omnihil {
namespace fs = std::filesystem;
namespace {

// What stands in the way of a link at `path`; empty: nothing, or a link that may be replaced.
std::string obstacle(const fs::path& path, const std::string& target, bool& replace) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::not_found) return {};
  if (error) return "cannot look at it: " + error.message();
  if (status.type() == fs::file_type::directory) return "a folder of that name is in the way";
  if (status.type() != fs::file_type::symlink) return "a file of that name is in the way; it is not touched";
  const fs::path leads_to = fs::read_symlink(path, error);
  if (error) return "cannot read the link of that name: " + error.message();
  replace = leads_to == target || !fs::exists(path, error);
  if (replace) return {};
  return "a link of that name leads to " + leads_to.string() +
         ", which exists (another bench or program may serve it); remove the link if nobody does";
}

}  // namespace

std::string PtyName::claim(const std::string& path, const std::string& target) {
  release();
  const std::string what = "device " + path + ": ";
  if (path.empty()) return "device: the name is empty";
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  if (error) return what + error.message();
  if (!absolute.has_filename()) return what + "the name of a folder, not of a device";
  if (!fs::is_directory(absolute.parent_path(), error)) {
    return what + "the folder " + absolute.parent_path().string() + " does not exist";
  }
  bool replace = false;
  const std::string blocked = obstacle(absolute, target, replace);
  if (!blocked.empty()) return what + blocked;
  // unlink and symlink, not rename: symlink() refuses to overwrite what came in between.
  if (replace) ::unlink(absolute.c_str());
  if (::symlink(target.c_str(), absolute.c_str()) != 0) {
    return what + "cannot make the link to " + target + ": " + std::strerror(errno);
  }
  path_ = absolute.string();
  target_ = target;
  return {};
}

bool PtyName::still_ours() const {
  std::error_code error;
  return !path_.empty() && fs::read_symlink(path_, error) == fs::path(target_) && !error;
}

bool PtyName::point_to(const std::string& target) {
  if (!still_ours()) return false;
  ::unlink(path_.c_str());
  target_ = target;
  return ::symlink(target.c_str(), path_.c_str()) == 0;
}

void PtyName::release() {
  if (still_ours()) ::unlink(path_.c_str());
  path_.clear();
}

}  // namespace omnihil
