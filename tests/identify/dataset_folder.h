// A small dataset in a folder of its own, for tests; removed at the end.
//
//   DatasetFolder folder;
//   folder.write("fit.csv", "time_s,duty,speed\n0,0,0\n0.1,0.5,1\n");
//   DatasetReading r = read_dataset(folder.path());
#pragma once
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "hil/dataset/dataset_reader.h"

namespace omnihil {

inline constexpr const char* kAxisModel =
    "format = \"omnihil-model/1\"\nrig = \"axis\"\n[motor]\nresistance_ohm = 1.0\n"
    "torque_constant_Nm_per_A = 0.03\nrotor_inertia_kg_m2 = 1e-5\n[supply]\nvoltage_V = 12.0\n";
inline constexpr const char* kAxisDataset =
    "format = \"omnihil-dataset/1\"\ntitle = \"t\"\nrig = \"axis\"\nmodel = \"model.toml\"\n[channels]\n"
    "time = { column = \"time_s\" }\nduty = { column = \"duty\" }\nvelocity = { column = \"speed\" }\n"
    "[[runs]]\nfile = \"fit.csv\"\nuse = \"fit\"\n[[runs]]\nfile = \"held.csv\"\nuse = \"holdout\"\n";
inline constexpr const char* kAxisRun = "time_s,duty,speed\n0,0,0\n0.001,0.5,1\n0.002,0.5,2\n";

class DatasetFolder {
 public:
  DatasetFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "omnihil-dataset-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
    write("dataset.toml", kAxisDataset);
    write("model.toml", kAxisModel);
    write("fit.csv", kAxisRun);
    write("held.csv", kAxisRun);
  }
  ~DatasetFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  DatasetFolder(const DatasetFolder&) = delete;
  DatasetFolder& operator=(const DatasetFolder&) = delete;

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }
  // Replaces `from` in the dataset.toml of the start.
  void change(const std::string& from, const std::string& to) {
    const std::size_t at = toml_.find(from);
    if (at != std::string::npos) toml_.replace(at, from.size(), to);
    write("dataset.toml", toml_);
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
  std::string toml_ = kAxisDataset;
};

// The folder of shared measurements, where this machine has one.
inline std::optional<std::filesystem::path> shared_data() {
  const char* shared = std::getenv("OMNIHIL_SHARED");
  if (shared == nullptr) return std::nullopt;
  const std::filesystem::path data = std::filesystem::path(shared) / "data";
  return std::filesystem::is_directory(data) ? std::optional(data) : std::nullopt;
}

inline std::string all_text(const std::vector<ModelProblem>& problems) {
  std::string text;
  for (const ModelProblem& problem : problems) text += problem.text() + "\n";
  return text;
}

}  // namespace omnihil
