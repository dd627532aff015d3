// Output that appears whole or not at all: written beside its final name, then renamed.
//
//   NewFolder folder("run/dataset");                 // throws FileExists when that is there and not empty
//   folder.write("dataset.toml", text);
//   folder.finish();                                 // without it, nothing is left behind
//
// I/O failures are thrown as std::system_error with the path.
#pragma once
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace omnihil {

class FileExists : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class NewFolder {
 public:
  explicit NewFolder(const std::filesystem::path& path);
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  void write(const std::string& name, std::string_view text);
  void finish();

 private:
  std::filesystem::path path_;
  std::filesystem::path making_;  // empty when finished
};

// One file, the same way. Refuses to replace one that is there.
void write_new_file(const std::filesystem::path& path, std::string_view text);

// One file that may be there already: it is replaced at once, or not at all.
void replace_file(const std::filesystem::path& path, std::string_view text);

// The same; what was there is kept as PATH.1 (PATH.1 of before is lost).
void replace_file_keeping_old(const std::filesystem::path& path, std::string_view text);

}  // namespace omnihil
