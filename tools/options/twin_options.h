// The options of the live twin, on a recording and beside a tap.
//
//   add_twin_options(verb, words);
//   TwinRunner runner(twin_model(words), card_errors(words.model), twin_options(words), tell);
#pragma once
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "hil/twin/twin_runner.h"
#include "tools/command_line.h"

namespace omnihil {

struct TwinWords {
  std::string model, log;
  int robot = -1;  // -1: the only one
  double learn_s = 60.0, false_alarms_per_hour = 0.01;
};

void add_twin_options(Verb& verb, TwinWords& words);  // without --model
TwinOptions twin_options(const TwinWords& words);
// Throw std::invalid_argument.
Candidate twin_model(const TwinWords& words);
int twin_robot(const TwinWords& words, const std::vector<int>& robot_ids);

// Events as lines of JSON in a file, each there at once; nothing is done without --twin-log.
class TwinLog {
 public:
  explicit TwinLog(const TwinWords& words);  // throws std::system_error; FileExists
  void write(const TwinEvent& event);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace omnihil
