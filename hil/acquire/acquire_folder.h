// A measurement that grows run by run on disk, and takes its final name when it is whole.
//
//   AcquireFolder folder("bench", plan_text, model_text, resume);   // bench.part; throws FileExists, std::invalid_argument
//   if (!folder.has("fit_1")) folder.add_run("fit_1", csv, packets, note);
//   folder.describe(dataset_text, readme);                           // bench.part is a dataset now
//   folder.finish();                                                 // and bench.part becomes bench
//
// A run is one CSV; it is there when it is whole. Beside it packets/NAME.txt, the bytes both ways, and packets/NAME.note,
// what the README says of it. plan.toml and model.toml are those that it was begun with: going on with others is refused.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace omnihil {

class AcquireFolder {
 public:
  AcquireFolder(const std::filesystem::path& path, std::string_view plan_text, std::string_view model_text,
                bool resume);

  bool has(const std::string& run) const;
  void add_run(const std::string& run, std::string_view csv, std::string_view packets, std::string_view note);
  std::string csv(const std::string& run) const;  // of a run that is there
  std::string note(const std::string& run) const;
  void describe(std::string_view dataset_text, std::string_view readme);
  void finish();
  const std::filesystem::path& making() const { return making_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_, making_;
};

}  // namespace omnihil
