// What a reader of a measurement should know, run by run, said once per kind with the runs counted.
//
//   RunNotes notes;
//   notes.add("velocity: not measured", "b.csv");
//   notes.lines(10);       // "velocity: not measured in 1 of 10 runs (b.csv)"
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace omnihil {

class RunNotes {
 public:
  void add(const std::string& what, const std::string& run);
  std::vector<std::string> lines(std::size_t runs) const;

 private:
  std::vector<std::pair<std::string, std::vector<std::string>>> notes_;  // in order of appearance
};

}  // namespace omnihil
