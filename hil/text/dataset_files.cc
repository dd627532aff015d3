#include "hil/text/dataset_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

namespace omnihil {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(int error_number, const fs::path& path) {
  throw std::system_error(error_number, std::generic_category(), path.string());
}

void write_file(const fs::path& path, std::string_view text) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) fail(errno, path);
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error_number = errno;
      ::close(fd);
      fail(error_number, path);
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::close(fd) != 0) fail(errno, path);
}

fs::path clean(const fs::path& path) {
  const fs::path normal = fs::absolute(path).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();  // without a slash at the end
}

// A new folder beside `path`, on the same file system so that it can be renamed to it.
fs::path make_beside(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) fail(error.value(), path.parent_path());
  std::string name = (path.parent_path() / (".making-" + path.filename().string() + "-XXXXXX")).string();
  if (::mkdtemp(name.data()) == nullptr) fail(errno, path);
  return name;
}

}  // namespace

NewFolder::NewFolder(const fs::path& path) : path_(clean(path)) {
  std::error_code error;
  const bool exists = fs::exists(fs::symlink_status(path_, error));
  if (exists && !(fs::is_directory(path_, error) && fs::is_empty(path_, error))) {
    throw FileExists(path.string() + ": exists and is not an empty folder; nothing was written");
  }
  making_ = make_beside(path_);
  fs::permissions(
      making_,
      fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec,
      fs::perm_options::add, error);
}

NewFolder::~NewFolder() {
  std::error_code ignored;
  if (!making_.empty()) fs::remove_all(making_, ignored);
}

void NewFolder::write(const std::string& name, std::string_view text) { write_file(making_ / name, text); }

void NewFolder::finish() {
  std::error_code error;
  fs::rename(making_, path_, error);
  if (error) fail(error.value(), path_);
  making_.clear();
}

void write_new_file(const fs::path& path, std::string_view text) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(clean(path), error))) {
    throw FileExists(path.string() + ": exists; nothing was written");
  }
  replace_file(path, text);
}

void replace_file(const fs::path& path, std::string_view text) {
  const fs::path target = clean(path);
  const fs::path folder = make_beside(target);
  const fs::path making = folder / "file";
  std::error_code error;
  try {
    write_file(making, text);
    fs::rename(making, target);
  } catch (...) {
    fs::remove_all(folder, error);
    throw;
  }
  fs::remove_all(folder, error);
}

void replace_file_keeping_old(const fs::path& path, std::string_view text) {
  const fs::path target = clean(path);
  fs::path old = target;
  old += ".1";
  std::error_code error;
  if (fs::exists(target, error)) {
    fs::copy_file(target, old, fs::copy_options::overwrite_existing, error);
    if (error) fail(error.value(), old);
  }
  replace_file(path, text);
}

}  // namespace omnihil
