// A measurement folder: dataset.toml, the model, a run to fit and one held out, apart by lines of "%%".
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "hil/dataset/dataset_reader.h"
#include "tests/fuzz/fuzz_target.h"

namespace omnihil {
namespace {

// Of this process, in memory where the computer has such a place.
const std::filesystem::path& folder() {
  static const struct Folder {
    std::filesystem::path path =
        (std::filesystem::exists("/dev/shm") ? std::filesystem::path("/dev/shm")
                                             : std::filesystem::temp_directory_path()) /
        ("omnihil-fuzz-" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
  } kFolder;
  return kFolder.path;
}

void write(const char* name, std::string_view text) {
  std::ofstream(folder() / name, std::ios::binary) << text;
}

}  // namespace
}  // namespace omnihil

OMNIHIL_FUZZ_TARGET(bytes) {
  using namespace omnihil;
  std::string_view rest = text_of(bytes);
  for (const char* name : {"dataset.toml", "model.toml", "fit.csv", "held.csv"}) {
    const std::size_t end = rest.find("%%\n");
    write(name, rest.substr(0, end));
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 3);
  }
  const DatasetReading reading = read_dataset(folder().string());
  demand(reading.dataset.has_value() == reading.problems.empty(), "a dataset or a problem");
  demand(reading.dataset.has_value() == reading.nominal.has_value(), "both or none");
  for (const ModelProblem& problem : reading.problems) demand(!problem.text().empty(), "a problem has words");
}
