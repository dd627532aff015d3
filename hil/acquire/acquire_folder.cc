#include "hil/acquire/acquire_folder.h"

#include <stdexcept>
#include <system_error>

#include "hil/text/dataset_files.h"
#include "hil/text/text_file.h"

namespace omnihil {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::string error;
  std::string text = read_text_file(path, error);
  if (!error.empty()) throw std::invalid_argument(path.string() + ": " + error);
  return text;
}

}  // namespace

AcquireFolder::AcquireFolder(const fs::path& path, std::string_view plan_text, std::string_view model_text,
                             bool resume)
    : path_(path), making_(path) {
  making_ += ".part";
  if (fs::exists(path_) && (!fs::is_directory(path_) || !fs::is_empty(path_)))
    throw FileExists(path_.string() + ": is there already");
  const bool begun = fs::exists(making_ / "plan.toml");
  if (begun && !resume)
    throw FileExists(making_.string() + ": a measurement was begun there; --resume goes on with it");
  if (!begun) {
    fs::create_directories(making_ / "packets");
    replace_file(making_ / "model.toml", model_text);
    replace_file(making_ / "plan.toml", plan_text);
    return;
  }
  for (const auto& [name, text] : {std::pair("plan.toml", plan_text), std::pair("model.toml", model_text)}) {
    if (read(making_ / name) != text)
      throw std::invalid_argument((making_ / name).string() +
                                  ": was begun with another one; --resume goes on with the same alone");
  }
}

bool AcquireFolder::has(const std::string& run) const { return fs::exists(making_ / (run + ".csv")); }

void AcquireFolder::add_run(const std::string& run, std::string_view csv, std::string_view packets,
                            std::string_view note) {
  replace_file(making_ / "packets" / (run + ".txt"), packets);
  replace_file(making_ / "packets" / (run + ".note"), note);
  replace_file(making_ / (run + ".csv"), csv);  // last: it says that the run is there
}

std::string AcquireFolder::csv(const std::string& run) const { return read(making_ / (run + ".csv")); }
std::string AcquireFolder::note(const std::string& run) const {
  return read(making_ / "packets" / (run + ".note"));
}

void AcquireFolder::describe(std::string_view dataset_text, std::string_view readme) {
  replace_file(making_ / "README.md", readme);
  replace_file(making_ / "dataset.toml", dataset_text);
}

void AcquireFolder::finish() {
  std::error_code error;
  fs::remove(path_, error);  // an empty folder
  fs::rename(making_, path_);
}

}  // namespace omnihil
